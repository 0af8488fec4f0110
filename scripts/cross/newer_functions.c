// Functions that the C library has got since glibc 2.27 and that our code, or the C++ library's, calls: for libraries that
// run on older machines, see old_libraries.py. Each module has its own, which others do not see.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

// Not for other modules.
#define OWN __attribute__((visibility("hidden")))

// glibc 2.32: whether a process has never had a second thread. 0 is always safe: the C++ library uses atomic operations then.
OWN char __libc_single_threaded = 0;

// glibc 2.33: until then, headers made calls of these functions with the layout's version of struct stat.
#ifdef __x86_64__
#define STAT_VERSION 1
#else
#define STAT_VERSION 0
#endif
int __xstat(int version, char const* path, struct stat* status);
int __lxstat(int version, char const* path, struct stat* status);
int __fxstat(int version, int file, struct stat* status);
int __fxstatat(int version, int folder, char const* path, struct stat* status, int flags);

OWN int stat(char const* path, struct stat* status) {
    return __xstat(STAT_VERSION, path, status);
}
OWN int lstat(char const* path, struct stat* status) {
    return __lxstat(STAT_VERSION, path, status);
}
OWN int fstat(int file, struct stat* status) {
    return __fxstat(STAT_VERSION, file, status);
}
OWN int fstatat(int folder, char const* path, struct stat* status, int flags) {
    return __fxstatat(STAT_VERSION, folder, path, status, flags);
}

// The same with large files, which are the same on 64-bit machines.
OWN int stat64(char const* path, struct stat64* status) {
    return __xstat(STAT_VERSION, path, (struct stat*)status);
}
OWN int lstat64(char const* path, struct stat64* status) {
    return __lxstat(STAT_VERSION, path, (struct stat*)status);
}
OWN int fstat64(int file, struct stat64* status) {
    return __fxstat(STAT_VERSION, file, (struct stat*)status);
}

// glibc 2.28.
OWN int renameat2(int old_folder, char const* old_path, int new_folder, char const* new_path, unsigned flags) {
    return (int)syscall(SYS_renameat2, old_folder, old_path, new_folder, new_path, flags);
}

// newer_NAME is the function of the machine's library, if that is new enough, else null. It is looked up before all else,
// since some of these are called by handlers of signals, or often.
#define NEWER(result, name, ...)                                      \
    static result (*newer_##name)(__VA_ARGS__);                       \
    __attribute__((constructor(101))) static void find_##name(void) { \
        void* const found = dlsym(RTLD_DEFAULT, #name);               \
        memcpy(&newer_##name, &found, sizeof found);                  \
    }
NEWER(struct mallinfo2, mallinfo2, void)
NEWER(pid_t, _Fork, void)
NEWER(int, pthread_cond_clockwait, pthread_cond_t*, pthread_mutex_t*, clockid_t, struct timespec const*)

// glibc 2.33: the older function counts bytes in an int. Its values are right modulo 4 GiB.
OWN struct mallinfo2 mallinfo2(void) {
    if (newer_mallinfo2 != NULL) {
        return newer_mallinfo2();
    }
    struct mallinfo2 result;
    memset(&result, 0, sizeof result);
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
    struct mallinfo const older = mallinfo();
#pragma GCC diagnostic pop
    result.arena = (unsigned)older.arena;
    result.hblkhd = (unsigned)older.hblkhd;
    result.uordblks = (unsigned)older.uordblks;
    result.fordblks = (unsigned)older.fordblks;
    return result;
}

// glibc 2.34: fork() without the functions of pthread_atfork(). Older libraries always call them. __fork(), since our library
// replaces fork().
pid_t __fork(void);
OWN pid_t _Fork(void) {
    return newer__Fork != NULL ? newer__Fork() : __fork();
}

// glibc 2.30: waits until a time of a clock. Older ones know the clock of the condition only, here that of the day.
OWN int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                               struct timespec const* until) {
    if (newer_pthread_cond_clockwait != NULL) {
        return newer_pthread_cond_clockwait(condition, mutex, clock, until);
    }
    long const second_ns = 1000000000L;
    struct timespec now;
    struct timespec day;
    if (clock_gettime(clock, &now) != 0 || clock_gettime(CLOCK_REALTIME, &day) != 0) {
        return errno;
    }
    long ns = day.tv_nsec + until->tv_nsec - now.tv_nsec;
    day.tv_sec += until->tv_sec - now.tv_sec;
    for (; ns < 0; ns += second_ns) {
        --day.tv_sec;
    }
    for (; ns >= second_ns; ns -= second_ns) {
        ++day.tv_sec;
    }
    day.tv_nsec = ns;
    return pthread_cond_timedwait(condition, mutex, &day);
}
