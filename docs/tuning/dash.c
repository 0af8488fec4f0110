// A robot that drives one arc and stops: what it reaches follows from its parameters in closed form.
//
// With the powers L and R of its motors, from 0 to 1, it drives at v = max_linear_speed (L + R) / 2 and turns at
// w = 2 max_angular_speed (L - R), for the time T. So its heading changes by w T, and it gets as far as the chord of
// the arc, |2 v / w sin(w T / 2)|.
#include "pogobase.h"

typedef struct {
    uint32_t driven_ticks;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
uint16_t left_power = 1023;   // 0 to 1023
uint16_t right_power = 1023;  // 0 to 1023
uint32_t drive_ticks = 250;   // of 20 ms

void user_init(void) {
    main_loop_hz = 50;
}

void user_step(void) {
    bool const drives = pogobot_ticks < drive_ticks;
    mydata->driven_ticks += drives;
    pogobot_motor_set(motorL, drives ? left_power : motorStop);
    pogobot_motor_set(motorR, drives ? right_power : motorStop);
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(left_power);
    init_from_configuration(right_power);
    init_from_configuration(drive_ticks);
}
static void create_data_schema(void) {
    data_add_column_double("driven_s");
}
static void export_data(void) {
    data_set_value_double("driven_s", mydata->driven_ticks / (double)main_loop_hz);
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
