// A program that does something wrong on demand: robot `culprit` commits `kind` in `place`, in user_step at tick 10.
#define _GNU_SOURCE  // -std=c11 alone hides nanosleep()
#include <errno.h>
#include <pthread.h>
#include <sys/select.h>
#include <unistd.h>

#include "pogobase.h"

#define TICK_OF_THE_MISDEED 10

typedef struct {
    uint8_t bytes[24];
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

char kind[32] = "nothing";
char place[32] = "user_step";
uint16_t culprit = 1;
int32_t number = 5;
bool announced = false;  // robot 0 says so right before the misdeed in user_step

POGO_SHARED volatile int zero = 0;
POGO_SHARED int* volatile nowhere = NULL;
POGO_SHARED volatile unsigned long spins = 0;

static void write_to_null(void) {
    printf("going to write to null");  // without end of line
    *nowhere = 1;
}

static void divide_by_zero(void) {
    number = number / zero;
}

static void loop_for_ever(void) {
    for (;;) {
        spins++;
    }
}

// Most of the time is spent inside of the C library, under its locks.
static void allocate_for_ever(void) {
    for (;;) {
        char* volatile blocks[20];
        for (size_t i = 0; i < 20; i++) {
            blocks[i] = malloc(10 + (size_t)rand() % 5000);
        }
        for (size_t i = 0; i < 20; i++) {
            free(blocks[i]);
        }
    }
}

static void print_for_ever(void) {
    for (;;) {
        printf("again and ");
    }
}

static void sleep_for_ever(void) {
    for (;;) {
        pause();
    }
}

static void sleep_again_when_interrupted(void) {
    struct timespec left = {.tv_sec = 1000000};
    while (nanosleep(&left, &left) != 0 && errno == EINTR) {
    }
}

static void wait_for_a_mutex(void) {
    POGO_SHARED static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&mutex);
    pthread_mutex_lock(&mutex);
}

static void read_from_nobody(void) {
    int ends[2];
    char byte = 0;
    if (pipe(ends) == 0) {
        spins += (unsigned long)read(ends[0], &byte, 1);
    }
}

static void select_nothing(void) {
    while (select(0, NULL, NULL, NULL, NULL) != 0) {
    }
}

static void free_what_is_not_allocated(void) {
    char* volatile text = kind;
    free(text);
}

static void free_twice(void) {
    char* volatile block = malloc(2000);
    char* volatile next = malloc(20);
    free(block);
    free(block);
    free(next);
}

// Destroys memory of the simulator's own, up to its end.
static void write_over_the_heap(void) {
    for (char volatile* byte = (char*)malloc(20);; byte++) {
        *byte = 'A';
    }
}

static int sum_on_the_stack(int depth) {
    volatile int frame[1024];
    frame[0] = depth;
    return depth == zero ? 0 : sum_on_the_stack(depth + 1) + frame[0];
}

static void overflow_the_stack(void) {
    spins = (unsigned long)sum_on_the_stack(1);
}

static void write_beyond_userdata(void) {
    // The end of all user data is somewhere behind that of the last robot.
    uint8_t volatile* bytes = mydata->bytes;
    for (size_t i = 0; i < 1000000; i++) {
        bytes[i] = 1;
    }
}

static void end_the_thread(void) {
    pthread_exit(NULL);
}

static void exit_with_7(void) {
    exit(7);
}

static void exit_with_2(void) {
    exit(2);
}

static void exit_with_0(void) {
    exit(0);
}

static void set_unknown_column(void) {
    data_set_value_int8("nobody declared this", 1);
}

static void set_wrong_type(void) {
    data_set_value_double("declared_as_int16", 1.0);
}

static void declare_column_twice(void) {
    data_add_column_int16("declared_as_int16");
}

static void read_number(void) {
    init_from_configuration(number);
}

static struct {
    char const* name;
    void (*commit)(void);
} const misdeeds[] = {
    {"write_to_null", write_to_null},
    {"divide_by_zero", divide_by_zero},
    {"loop_for_ever", loop_for_ever},
    {"sleep_for_ever", sleep_for_ever},
    {"sleep_again_when_interrupted", sleep_again_when_interrupted},
    {"wait_for_a_mutex", wait_for_a_mutex},
    {"read_from_nobody", read_from_nobody},
    {"select_nothing", select_nothing},
    {"allocate_for_ever", allocate_for_ever},
    {"print_for_ever", print_for_ever},
    {"free_what_is_not_allocated", free_what_is_not_allocated},
    {"free_twice", free_twice},
    {"write_over_the_heap", write_over_the_heap},
    {"overflow_the_stack", overflow_the_stack},
    {"write_beyond_userdata", write_beyond_userdata},
    {"abort", abort},
    {"end_the_thread", end_the_thread},
    {"exit_with_7", exit_with_7},
    {"exit_with_2", exit_with_2},
    {"exit_with_0", exit_with_0},
    {"set_unknown_column", set_unknown_column},
    {"set_wrong_type", set_wrong_type},
    {"declare_column_twice", declare_column_twice},
    {"read_number", read_number},
    {"stop_simulation", stop_simulation},
};

static void misbehave(char const* here) {
    for (size_t i = 0; i < sizeof(misdeeds) / sizeof(misdeeds[0]) && strcmp(here, place) == 0; i++) {
        if (strcmp(kind, misdeeds[i].name) == 0) {
            misdeeds[i].commit();
        }
    }
}

static void misbehave_if_culprit(char const* here) {
    if (pogobot_helper_getid() == culprit) {
        misbehave(here);
    }
}

void user_init(void) {
    misbehave_if_culprit("user_init");
}

void user_step(void) {
    if (pogobot_ticks == 0 && pogobot_helper_getid() == 0) {
        printf("first tick\n");
    }
    if (pogobot_ticks == TICK_OF_THE_MISDEED) {
        if (announced && pogobot_helper_getid() == 0) {
            printf("here it comes\n");
        }
        misbehave_if_culprit("user_step");
    }
}

static void global_setup(void) {
    misbehave("global_setup");
}

static void create_data_schema(void) {
    data_add_column_int16("declared_as_int16");
    misbehave("create_data_schema");
}

static void export_data(void) {
    data_set_value_int16("declared_as_int16", 16);
    // Not at time 0: there must be something in the file.
    if (pogobot_ticks > 0) {
        misbehave_if_culprit("export_data");
    }
}

static void global_step(void) {
    if (pogobot_ticks == TICK_OF_THE_MISDEED) {
        misbehave("global_step");
    }
}

static void robot_end(void) {
    misbehave_if_culprit("robot_end");
}

int main(void) {
    init_array_from_configuration(kind);
    init_array_from_configuration(place);
    init_from_configuration(culprit);
    init_from_configuration(announced);
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    SET_CALLBACK(callback_global_step, global_step);
    SET_CALLBACK(callback_robot_end, robot_end);
    misbehave_if_culprit("main");
    return 0;
}
