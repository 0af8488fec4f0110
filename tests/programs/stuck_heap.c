// Crashes as if a lock of the heap were held: once the message is in standard error, a file, larger blocks cannot be
// freed any more.
#define _GNU_SOURCE
#include <malloc.h>
#include <signal.h>
#include <stdbool.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pogobase.h"

enum { LARGEST_WITHOUT_LOCK = 1032 };  // bytes; each thread has a cache of smaller blocks

void __libc_free(void* block);

POGO_SHARED static bool volatile has_crashed = false;

static bool is_message_written(void) {
    struct stat errors;
    return fstat(STDERR_FILENO, &errors) == 0 && errors.st_size > 0;
}

void free(void* block) {
    while (has_crashed && malloc_usable_size(block) > LARGEST_WITHOUT_LOCK && is_message_written()) {
        pause();
    }
    __libc_free(block);
}

void user_init(void) {}

void user_step(void) {
    if (pogobot_ticks == 30) {
        has_crashed = true;
        raise(SIGSEGV);
    }
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
