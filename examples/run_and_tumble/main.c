// Run and tumble: the random walk of swimming bacteria (Berg, "E. coli in Motion", 2004).
//
// Shows: parameters from the configuration file, random numbers, motor directions, a program with two phases.
//
// A robot runs straight ahead (green) for a random time, then turns on the spot to a random side (red) for a random
// time, and so on. Over times shorter than a run it moves like a bullet, over much longer ones it diffuses.
//
//     ./examples/run_and_tumble/run_and_tumble -c conf/simple.yaml
#include "pogobase.h"

typedef enum { PHASE_RUN, PHASE_TUMBLE } phase_t;

typedef struct {
    phase_t phase;
    uint32_t phase_start_ms;
    uint32_t phase_duration_ms;
    uint8_t forward_dir[3];  // calibration of this robot: direction bits [right, left, back] that drive it forward
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots. The simulator overrides them from the configuration file.
uint32_t run_duration_min = 200;      // ms
uint32_t run_duration_max = 1200;     // ms
uint32_t tumble_duration_min = 100;   // ms
uint32_t tumble_duration_max = 1100;  // ms
bool enable_backward_dir = false;     // half of the runs go backwards
float test_vect[4] = {1.0f, 2.0f, 3.0f, 4.0f};

static uint32_t random_between(uint32_t low, uint32_t high) {
    return high > low ? low + (uint32_t)rand() % (high - low + 1) : low;
}

// Both direction bits as calibrated, or both inverted.
static void set_direction(bool forward) {
    uint8_t const flip = forward ? 0 : 1;
    pogobot_motor_dir_set(motorR, mydata->forward_dir[0] ^ flip);
    pogobot_motor_dir_set(motorL, mydata->forward_dir[1] ^ flip);
}

static void start_run(void) {
    mydata->phase = PHASE_RUN;
    mydata->phase_duration_ms = random_between(run_duration_min, run_duration_max);
    pogobot_led_setColor(0, 255, 0);
    set_direction(!enable_backward_dir || rand() % 2 == 0);
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorFull);
}

static void start_tumble(void) {
    mydata->phase = PHASE_TUMBLE;
    mydata->phase_duration_ms = random_between(tumble_duration_min, tumble_duration_max);
    pogobot_led_setColor(255, 0, 0);
    set_direction(true);
    bool const to_left = rand() % 2 == 0;
    pogobot_motor_set(motorL, to_left ? motorStop : motorFull);
    pogobot_motor_set(motorR, to_left ? motorFull : motorStop);
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    pogobot_motor_dir_mem_get(mydata->forward_dir);

    mydata->phase_start_ms = current_time_milliseconds();
    if (rand() % 2 == 0) {
        start_run();
    } else {
        start_tumble();
    }
    if (pogobot_helper_getid() == 0) {
        printf("test_vect: %.1f %.1f %.1f %.1f\n", (double)test_vect[0], (double)test_vect[1], (double)test_vect[2],
               (double)test_vect[3]);
    }
}

void user_step(void) {
    uint32_t const now_ms = current_time_milliseconds();
    if (now_ms - mydata->phase_start_ms >= mydata->phase_duration_ms) {
        mydata->phase_start_ms = now_ms;
        if (mydata->phase == PHASE_RUN) {
            start_tumble();
        } else {
            start_run();
        }
    }

    if (pogobot_helper_getid() == 0 && pogobot_ticks % 1000 == 0) {
        printf("phase: %s\n", mydata->phase == PHASE_RUN ? "RUN" : "TUMBLE");
    }
}

#ifdef SIMULATOR
#define MAX_DURATION_MS 10000000  // nearly three hours

// Called once, before the robots start.
static void global_setup(void) {
    init_from_configuration(run_duration_min);
    check_parameter(run_duration_min, 0, MAX_DURATION_MS);
    init_from_configuration(run_duration_max);
    check_parameter(run_duration_max, 0, MAX_DURATION_MS);
    init_from_configuration(tumble_duration_min);
    check_parameter(tumble_duration_min, 0, MAX_DURATION_MS);
    init_from_configuration(tumble_duration_max);
    check_parameter(tumble_duration_max, 0, MAX_DURATION_MS);
    init_from_configuration(enable_backward_dir);
    init_array_from_configuration(test_vect);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}
