/// @file
/// Robot output. Text is buffered until a line is complete (or the run ends, or 64 KiB are waiting); the line then
/// goes to the log of the run as "[ROBOT #id] [PRINTF] line".
#ifndef POGOSIM_POGOLIB_CONSOLE_H
#define POGOSIM_POGOLIB_CONSOLE_H

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

// What the macros below call.
int pogosim_printf(char const* format, ...);
int pogosim_vprintf(char const* format, va_list arguments);
int pogosim_putchar(int character);
int pogosim_puts(char const* text);

// The program's main(), renamed by pogosim/pogolib.h. With arguments it has the same name for the linker.
#if !defined(POGOSIM_FOR_SDK) || defined(__cplusplus)
int robot_main(void);
#endif
#define POGO_SYMBOL_PREFIX(prefix) POGO_SYMBOL_PREFIX_RAW(prefix)
#define POGO_SYMBOL_PREFIX_RAW(prefix) #prefix
#define POGO_ROBOT_MAIN __asm__(POGO_SYMBOL_PREFIX(__USER_LABEL_PREFIX__) "robot_main")
#ifdef __cplusplus
#define POGO_MAIN_WITH_ARGUMENTS robot_main_with_arguments
extern "C++" {
int robot_main_with_arguments(int argc, char** argv) POGO_ROBOT_MAIN;
int robot_main_with_arguments(int argc, char const** argv) POGO_ROBOT_MAIN;
int robot_main_with_arguments(int argc, char** argv, char** environment) POGO_ROBOT_MAIN;
}
#else
// In C there is one declaration, and only the program knows the types in it.
#define POGO_MAIN_WITH_ARGUMENTS(...)                                                              \
    robot_main_with_arguments(__VA_ARGS__) POGO_ROBOT_MAIN __attribute__((visibility("default"))); \
    int robot_main_with_arguments(__VA_ARGS__)
#endif

POGO_END_API
#ifdef __cplusplus
}
extern "C++" {
namespace std {  // for std::printf and the like, which the macros below turn into these
using ::pogosim_printf;
using ::pogosim_putchar;
using ::pogosim_puts;
using ::pogosim_vprintf;
}  // namespace std
}
#endif

#undef printf
#undef putchar
#undef puts
#undef vprintf

/// Prints like the robot's own C library, where `long` has 32 bits: `%ld` and `%lu` print an int32_t or uint32_t.
/// Returns the number of characters, or a negative value for a bad format.
/// @range returns the number of characters
#define printf(...) pogosim_printf(__VA_ARGS__)
/// Prints one character and returns it.
/// @range character: 0 to 255, which it returns
#define putchar(character) pogosim_putchar(character)
/// Prints a string and a newline. Returns 0.
/// @range returns 0
#define puts(text) pogosim_puts(text)
/// Like printf(), with the arguments in a va_list.
/// @range returns the number of characters
#define vprintf(format, arguments) pogosim_vprintf(format, arguments)

#endif
