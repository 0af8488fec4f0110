// Robots whose variables are globals and static variables, as programs for the robots alone have them. Each column says
// what a robot finds there.
#include "pogobase.h"

typedef struct {
    uint8_t unused;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

uint32_t steps;                  // .bss
int32_t countdown = 1000;        // .data
static uint8_t far_away[20000];  // of which each robot writes to another place
uint32_t* pointer = &steps;
int32_t parameter = 5;
float array_parameter[3] = {1.0F, 2.0F, 3.0F};
uint32_t set_in_setup;
int32_t of_main;
char* allocated;
POGO_SHARED uint32_t steps_of_all;
POGO_SHARED static uint32_t ends;

static uint32_t next_number(void) {
    static uint32_t number = 100;
    return ++number;
}

static void global_setup(void) {
    init_from_configuration(parameter);
    init_array_from_configuration(array_parameter);
    set_in_setup = 77;
    far_away[19999] = 9;
}

void user_init(void) {
    srand(pogobot_helper_getid());
    main_loop_hz = 50;
    allocated = malloc(16);
    snprintf(allocated, 16, "robot %u", pogobot_helper_getid());
    countdown -= pogobot_helper_getid();
}

void user_step(void) {
    ++*pointer;
    ++steps_of_all;
    --countdown;
    far_away[1000 + 64 * pogobot_helper_getid()]++;
    of_main += (int32_t)next_number();
    if (pogobot_ticks == 10 && pogobot_helper_getid() == 1) {
        parameter = -1;
    }
}

static void create_data_schema(void) {
    data_add_column_int32("steps");
    data_add_column_int32("countdown");
    data_add_column_int32("own_place");
    data_add_column_int32("places");
    data_add_column_int32("parameter");
    data_add_column_int32("last_of_array");
    data_add_column_int32("set_in_setup");
    data_add_column_int32("sum");
    data_add_column_int32("all");
    data_add_column_string("text");
}

static void export_data(void) {
    int32_t places = 0;
    for (size_t i = 0; i < sizeof(far_away); ++i) {
        places += far_away[i] != 0;
    }
    data_set_value_int32("steps", (int32_t)steps);
    data_set_value_int32("countdown", countdown);
    data_set_value_int32("own_place", far_away[1000 + 64 * pogobot_helper_getid()]);
    data_set_value_int32("places", places);
    data_set_value_int32("parameter", parameter);
    data_set_value_int32("last_of_array", (int32_t)array_parameter[2]);
    data_set_value_int32("set_in_setup", (int32_t)set_in_setup);
    data_set_value_int32("sum", of_main);
    data_set_value_int32("all", (int32_t)steps_of_all);
    data_set_value_string("text", allocated);
}

static void robot_end(void) {
    printf("%lu steps, end %lu\n", (unsigned long)steps, (unsigned long)++ends);
}

int main(void) {
    of_main = 1 + of_main;
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    SET_CALLBACK(callback_robot_end, robot_end);
    return 0;
}
