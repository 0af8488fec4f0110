// The start of an executable, by way of the function that C libraries have had before glibc 2.34. They do not run its
// constructors unless they are told to, and the code that a compiler of today puts before main() leaves that to the newer
// function. Part of executables that old_libraries.py lets run on older machines.
typedef int Main(int count, char** words, char** environment);
typedef void Constructor(int count, char** words, char** environment);
#ifdef __x86_64__
__asm__(".symver start_of_old, __libc_start_main@GLIBC_2.2.5");
#else
__asm__(".symver start_of_old, __libc_start_main@GLIBC_2.17");
#endif
int start_of_old(Main* main, int count, char** words, int (*init)(int, char**, char**), void (*fini)(void),
                 void (*end_of_loader)(void), void* stack);
extern Constructor* __init_array_start[];
extern Constructor* __init_array_end[];

static int construct(int count, char** words, char** environment) {
    for (Constructor** next = __init_array_start; next != __init_array_end; ++next) {
        (*next)(count, words, environment);
    }
    return 0;
}

__attribute__((visibility("hidden"))) int __libc_start_main(Main* main, int count, char** words,
                                                            int (*init)(int, char**, char**), void (*fini)(void),
                                                            void (*end_of_loader)(void), void* stack) {
    (void)init;
    return start_of_old(main, count, words, construct, fini, end_of_loader, stack);
}
