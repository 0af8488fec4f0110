// Phototaxis: robots that look for light and stay where they find enough of it.
//
// Shows: reading the photosensors, a phase that follows a sensor at every tick.
//
// A robot wanders by run and tumble (green and red; see examples/run_and_tumble). It compares no directions: wherever
// the mean of its three photosensors reaches a threshold, it stops (blue), and goes on if it gets dark again or another
// robot pushes it out of the light. So the swarm gathers in the bright places, the simplest kind of orientation by
// light, called photokinesis in Fraenkel and Gunn, "The Orientation of Animals", 1940.
//
//     ./examples/phototaxis/phototaxis -c conf/phototaxis.yaml
#include "pogobase.h"

#define SENSOR_COUNT 3

typedef enum { PHASE_RUN, PHASE_TUMBLE, PHASE_GOAL } phase_t;

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
uint16_t light_goal_threshold = 800;  // sensor counts, 0 to 32767

static uint32_t random_between(uint32_t low, uint32_t high) {
    return high > low ? low + (uint32_t)rand() % (high - low + 1) : low;
}

static void set_motors(uint16_t left, uint16_t right) {
    pogobot_motor_set(motorL, left);
    pogobot_motor_set(motorR, right);
}

// Both direction bits as calibrated, or both inverted.
static void set_direction(bool forward) {
    uint8_t const flip = forward ? 0 : 1;
    pogobot_motor_dir_set(motorR, mydata->forward_dir[0] ^ flip);
    pogobot_motor_dir_set(motorL, mydata->forward_dir[1] ^ flip);
}

static int32_t mean_light(void) {
    int32_t sum = 0;
    for (uint8_t sensor = 0; sensor < SENSOR_COUNT; sensor++) {
        sum += pogobot_photosensors_read(sensor);
    }
    return sum / SENSOR_COUNT;
}

static void start_run(void) {
    mydata->phase = PHASE_RUN;
    mydata->phase_start_ms = current_time_milliseconds();
    mydata->phase_duration_ms = random_between(run_duration_min, run_duration_max);
    pogobot_led_setColor(0, 255, 0);
    set_direction(!enable_backward_dir || rand() % 2 == 0);
    set_motors(motorFull, motorFull);
}

static void start_tumble(void) {
    mydata->phase = PHASE_TUMBLE;
    mydata->phase_start_ms = current_time_milliseconds();
    mydata->phase_duration_ms = random_between(tumble_duration_min, tumble_duration_max);
    pogobot_led_setColor(255, 0, 0);
    set_direction(true);
    bool const to_left = rand() % 2 == 0;
    set_motors(to_left ? motorStop : motorFull, to_left ? motorFull : motorStop);
}

static void stay(void) {
    mydata->phase = PHASE_GOAL;
    pogobot_led_setColor(0, 0, 255);
    set_motors(motorStop, motorStop);
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    pogobot_motor_dir_mem_get(mydata->forward_dir);
    start_tumble();
}

void user_step(void) {
    if (mean_light() >= light_goal_threshold) {
        if (mydata->phase != PHASE_GOAL) {
            stay();
        }
        return;
    }
    if (mydata->phase == PHASE_GOAL) {
        start_tumble();
    } else if (current_time_milliseconds() - mydata->phase_start_ms >= mydata->phase_duration_ms) {
        if (mydata->phase == PHASE_RUN) {
            start_tumble();
        } else {
            start_run();
        }
    }
}

#ifdef SIMULATOR
#define MAX_DURATION_MS 10000000  // nearly three hours

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
    init_from_configuration(light_goal_threshold);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}
