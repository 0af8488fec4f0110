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
#define DECLARE_USERDATA(T)                              \
    POGO_IS_DECLARED                                     \
    POGO_MYDATA_OF_THREAD(T)                             \
    extern char REGISTER_USERDATA_once;                  \
    POGO_WITH_COUNTER POGO_ASK_FOR_USERDATA(__COUNTER__) \
    POGO_WITHOUT_COUNTER                                 \
    POGO_MAYBE_SEMICOLON
/// Tells the simulator how large user data are; once per program. Without it, the linker reports
/// `REGISTER_USERDATA_once` as undefined. The constant tells readers of debug information the type. In a file without
/// DECLARE_USERDATA, it declares `mydata`, too, as one for all threads: then the robots run on one.
#define REGISTER_USERDATA(T)                                                \
    POGO_PLAIN_MYDATA(T)                                                    \
    POGO_SHARED char REGISTER_USERDATA_once = 0;                            \
    POGO_SHARED size_t UserdataSize = sizeof(T);                            \
    __attribute__((used)) static T const* const pogo_user_data_type = NULL; \
    POGO_CONSTRUCT_USERDATA(T)                                              \
    POGO_MAYBE_SEMICOLON

// There are two variables `mydata`. DECLARE_USERDATA declares one that each thread has for itself, by another name for
// the linker; all other declarations of a program, such as `extern USERDATA* mydata;`, mean the plain one, which is a
// part of the program (user_data.c). In a file, the first macro decides: what REGISTER_USERDATA declares after
// DECLARE_USERDATA, and the other way round, is on a stack of definitions.
#define POGO_MYDATA_OF_ROBOT(T) \
    extern POGO_PER_ROBOT T* mydata __asm__(POGO_SYMBOL_PREFIX(__USER_LABEL_PREFIX__) "pogosim_mydata");
#define POGO_MYDATA_OF_PROGRAM(T) extern T* mydata;
#define POGO_IS_DECLARED _Pragma("pop_macro(\"POGO_PLAIN_MYDATA\")") _Pragma("push_macro(\"POGO_PLAIN_MYDATA\")")
#define POGO_IS_REGISTERED \
    _Pragma("pop_macro(\"POGO_MYDATA_OF_THREAD\")") _Pragma("push_macro(\"POGO_MYDATA_OF_THREAD\")")
// After DECLARE_USERDATA; before it, see below.
#define POGO_PLAIN_MYDATA(T)
#pragma push_macro("POGO_PLAIN_MYDATA")
#undef POGO_PLAIN_MYDATA
#define POGO_PLAIN_MYDATA(T) POGO_IS_REGISTERED POGO_MYDATA_OF_PROGRAM(T)
// After REGISTER_USERDATA alone; before it, see below.
#define POGO_MYDATA_OF_THREAD(T) POGO_MYDATA_OF_PROGRAM(T)
#pragma push_macro("POGO_MYDATA_OF_THREAD")
#undef POGO_MYDATA_OF_THREAD
#define POGO_MYDATA_OF_THREAD(T) POGO_MYDATA_OF_ROBOT(T)

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
