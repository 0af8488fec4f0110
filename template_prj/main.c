// A first program: robots turn to one side for a while, then to the other, and greet.
//
//     make clean sim
//     ./template_prj -c conf/test.yaml
#include "pogobase.h"

// The variables of one robot: simulated robots have a block each, on a real robot they are plain globals.
// All bytes are zero at the start.
typedef struct {
    uint32_t turning_since_ms;
    bool turns_left;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// A variable outside USERDATA is shared by all simulated robots. That is right for a parameter: global_setup reads it
// from `parameters:` in the configuration; real robots use the value given here.
uint32_t turn_duration = 10000;  // ms

static void turn(bool left) {
    mydata->turns_left = left;
    mydata->turning_since_ms = current_time_milliseconds();
    pogobot_led_setColor(left ? 25 : 0, 0, left ? 0 : 25);
    pogobot_motor_set(motorL, left ? motorStop : motorFull);
    pogobot_motor_set(motorR, left ? motorFull : motorStop);
}

// Called once, before the first step.
void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;  // calls of user_step per second
    turn(false);
}

// Called at each tick.
void user_step(void) {
    if (current_time_milliseconds() - mydata->turning_since_ms >= turn_duration) {
        turn(!mydata->turns_left);
    }
    if (pogobot_helper_getid() == 0 && pogobot_ticks % 1000 == 0) {
        printf("HELLO WORLD! I am robot %u, at tick %lu\n", pogobot_helper_getid(), (unsigned long)pogobot_ticks);
    }
}

#ifdef SIMULATOR  // what only the simulator has: parameters from the configuration, columns in the data file
static void global_setup(void) {
    init_from_configuration(turn_duration);
}

static void create_data_schema(void) {
    data_add_column_bool("turns_left");
}

static void export_data(void) {
    data_set_value_bool("turns_left", mydata->turns_left);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
