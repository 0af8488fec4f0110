// A program for runs inside another process: its robots use what the C library has in common for all, and may fail.
#include <stdio.h>

#include "pogobase.h"

typedef enum { RESTING, MOVING = 7 } State;

typedef struct {
    float gain;
    uint8_t age;
    int16_t levels[3];
    struct {
        double mean;
        bool known;
    } estimate;
    State state;
    uint32_t numbers[2];  // of rand()
    char name[8];
    void* self;
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

static float gain = 1.0f;
static int32_t fail_at_tick = -1;
static char failure[16] = "crash";
POGO_SHARED static uint32_t steps_of_all = 0;
POGO_SHARED static double table[2] = {1.0, 2.0};

static void fail(void) {
    if (strcmp(failure, "crash") == 0) {
        *(volatile int*)8 = 1;
    } else if (strcmp(failure, "loop") == 0) {
        for (volatile int i = 1; i > 0;) {
        }
    } else if (strcmp(failure, "exit") == 0) {
        exit(5);
    } else if (strcmp(failure, "success") == 0) {
        exit(0);
    } else if (strcmp(failure, "refuse") == 0) {
        refuse_parameter("failure", "something else");
    }
}

static void user_init(void) {
    srand(7);
    mydata->numbers[0] = (uint32_t)rand();
    mydata->levels[1] = -3;
    mydata->estimate.mean = 0.5;
    mydata->estimate.known = true;
    mydata->state = MOVING;
    mydata->self = mydata;
    strcpy(mydata->name, "abc");
    printf("hello from %d\n", pogobot_helper_getid());
}

static void user_step(void) {
    mydata->gain = gain;
    mydata->age++;
    mydata->numbers[1] = (uint32_t)rand();
    steps_of_all++;
    pogobot_led_setColor(mydata->age, 0, 0);
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorHalf);
    if ((int32_t)pogobot_ticks == fail_at_tick && pogobot_helper_getid() == 1) {
        fail();
    }
}

static void global_setup(void) {
    init_from_configuration(gain);
    init_from_configuration(fail_at_tick);
    init_string_from_configuration(failure, "failure", sizeof(failure));
    init_array_from_configuration(table);
    float local = 0.0f;
    init_float_from_configuration(&local, "local", 1.0f);
}

static void create_data_schema(void) {
    data_add_column_int32("steps_of_all");
    data_add_column_double("table_1");
}

static void export_data(void) {
    data_set_value_int32("steps_of_all", (int32_t)steps_of_all);
    data_set_value_double("table_1", table[1]);
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
