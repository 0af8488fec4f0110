// Makes all threads but the one that runs the robots crash, after half a second.
#define _GNU_SOURCE
#include <dirent.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "pogobase.h"

typedef struct {
    int unused;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

void user_init(void) {}

void user_step(void) {
    if (pogobot_helper_getid() != 0 || pogobot_ticks != 30) {
        return;
    }
    DIR* tasks = opendir("/proc/self/task");
    for (struct dirent* task = readdir(tasks); task != NULL; task = readdir(tasks)) {
        int const thread = atoi(task->d_name);
        if (thread != 0 && thread != getpid()) {
            syscall(SYS_tgkill, getpid(), thread, SIGSEGV);
        }
    }
    closedir(tasks);
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
