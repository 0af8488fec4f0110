// Robot 1 blocks at its tick 5, in wall-clock time, in the way `how` says.
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <sys/select.h>
#include <time.h>
#include <unistd.h>

#include "pogobase.h"

char how[32] = "nanosleep";
float seconds = 3.0f;

static bool is(char const* name) {
    return strcmp(how, name) == 0;
}

static void sleep_in_wall_clock_time(float wanted) {
    struct timespec const time = {(time_t)wanted, (long)((wanted - (float)(time_t)wanted) * 1e9f)};
    int const result = nanosleep(&time, NULL);  // nanosleep
    if (result != 0) {
        printf("interrupted: %d\n", errno);
    }
}

static void wait_for_lock(void) {
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += (time_t)seconds;
    pthread_mutex_lock(&mutex);
    int const result = pthread_mutex_timedlock(&mutex, &until);  // mutex
    printf("result %d\n", result == ETIMEDOUT);
}

static void compute(void) {
    struct timespec start;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &start);
    do {
        clock_gettime(CLOCK_MONOTONIC, &now);
    } while (now.tv_sec - start.tv_sec < (time_t)seconds);
}

static void block(void) {
    if (is("nanosleep")) {
        sleep_in_wall_clock_time(seconds);
    } else if (is("many short ones")) {
        for (int i = 0; i < 30; i++) {
            sleep_in_wall_clock_time(seconds / 30);
        }
    } else if (is("select")) {
        struct timeval time = {(time_t)seconds, 0};
        int const result = select(0, NULL, NULL, NULL, &time);  // select
        printf("result %d\n", result == 0);
    } else if (is("read")) {
        char letter = ' ';
        ssize_t const bytes = read(STDIN_FILENO, &letter, 1);  // read
        printf("result %d\n", bytes == 1 && letter == 'x');
    } else if (is("mutex")) {
        wait_for_lock();
    } else if (is("pointer")) {
        unsigned (*const of_the_c_library)(unsigned) = (unsigned (*)(unsigned))dlsym(RTLD_DEFAULT, "sleep");
        unsigned const left = of_the_c_library((unsigned)seconds);  // pointer
        printf("result %d\n", left == 0);
    } else if (is("compute")) {
        compute();
    } else if (is("print")) {
        for (int i = 0; i < 3000; i++) {
            printf("a line that goes to a reader who takes its time: %d\n", i);
        }
    }
}

void user_step(void) {
    if (pogobot_helper_getid() == 1 && pogobot_ticks == 5) {
        block();
    } else if (is("in many steps")) {
        sleep_in_wall_clock_time(seconds / 300);
    }
}

static void global_setup(void) {
    init_from_configuration(seconds);
}

int main(void) {
    init_array_from_configuration(how);
    pogobot_init();
    pogobot_start(NULL, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}
