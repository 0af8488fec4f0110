/// @file
/// User data: the variables of one robot. In the simulator, `mydata` points to the block of the current robot; on
/// a real robot, it is the address of a global, which the compiler folds away.
///
///     typedef struct { uint8_t age; } USERDATA;
///     DECLARE_USERDATA(USERDATA);    // next to the struct, wherever it is needed
///     REGISTER_USERDATA(USERDATA);   // once per program
///
/// Both work with and without the semicolon; as the last line of a C file, with it. All bytes are initially zero; in
/// C++, members may have initial values.
#ifndef POGOSIM_USERDATA_H
#define POGOSIM_USERDATA_H

// A lone semicolon may follow. In C, that is an extension; this keeps -Wpedantic silent about it.
#ifdef __cplusplus
#define POGO_MAYBE_SEMICOLON
#else
#define POGO_MAYBE_SEMICOLON __extension__
#endif

#ifdef REAL_ROBOT

#define DECLARE_USERDATA(T) \
    extern T myuserdata;    \
    POGO_MAYBE_SEMICOLON
#define REGISTER_USERDATA(T) \
    T myuserdata;            \
    POGO_MAYBE_SEMICOLON
#define mydata (&myuserdata)

#else

/// Declares `mydata`, a pointer to the T of the current robot; in each file of the program that uses it.
#define DECLARE_USERDATA(T)             \
    extern POGO_PER_ROBOT T* mydata;    \
    extern char REGISTER_USERDATA_once; \
    POGO_ASK_FOR_USERDATA(__COUNTER__)  \
    POGO_MAYBE_SEMICOLON
/// Tells the simulator how large user data are; once per program. Without it, the linker reports
/// `REGISTER_USERDATA_once` as undefined. The constant tells readers of debug information the type.
#define REGISTER_USERDATA(T)                                                \
    POGO_SHARED char REGISTER_USERDATA_once = 0;                            \
    POGO_SHARED size_t UserdataSize = sizeof(T);                            \
    __attribute__((used)) static T const* const pogo_user_data_type = NULL; \
    POGO_CONSTRUCT_USERDATA(T)                                              \
    POGO_MAYBE_SEMICOLON

// In C++ the user data of each robot are constructed, as the global of a real robot is.
#ifdef __cplusplus
extern "C++" {
struct pogosim_place {
    void* at;
};
inline void* operator new(size_t, pogosim_place place) noexcept {
    return place.at;
}
inline void operator delete(void*, pogosim_place) noexcept {}
}
#define POGO_CONSTRUCT_USERDATA(T) \
    POGO_SHARED void (*UserdataConstruct)(void*) = [](void* block) { ::new (pogosim_place{block}) T(); };
#else
#define POGO_CONSTRUCT_USERDATA(T)
#endif

// The library has the `mydata` of all programs, so without REGISTER_USERDATA a program would link, but robots would
// have no memory to write to. An unused constant refers to a symbol that only REGISTER_USERDATA defines.
#define POGO_ASK_FOR_USERDATA(number) POGO_ASK_FOR_USERDATA_RAW(number)
#define POGO_ASK_FOR_USERDATA_RAW(number) \
    __attribute__((used)) static char const* const pogo_user_data_##number = &REGISTER_USERDATA_once;

#endif

#endif
