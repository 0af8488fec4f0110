// Phototaxis by gradient: robots that climb towards the brightest place.
//
// Shows: making a vector out of the three photosensors, steering with two motors.
//
// In the dark a robot wanders by run and tumble (green and red; see examples/run_and_tumble), with the bias of swimming
// bacteria: runs that lead to more light last longer (Berg and Brown, "Chemotaxis in Escherichia coli analysed by
// three-dimensional tracking", Nature 239, 1972). As soon as it sees light (yellow), it drives towards the light,
// like vehicle 2b of Braitenberg's "Vehicles", 1984: the farther to the side, the slower the motor on that side.
//
//     ./examples/phototaxis_gradient/phototaxis_gradient -c conf/phototaxis_gradient.yaml
#include "pogobase.h"

// Photosensors sit on the rim: one at the back, two in front, 40 degrees to either side.
#define COS_40 0.766f
#define SIN_40 0.643f

typedef enum { PHASE_RUN, PHASE_TUMBLE, PHASE_CLIMB } phase_t;

// How the light changes around the robot: in sensor counts per body radius, except the level.
typedef struct {
    float level;  // mean of the three sensors, sensor counts
    float forward;
    float right;
} light_t;

typedef struct {
    phase_t phase;
    uint32_t phase_start_ms;
    uint32_t phase_duration_ms;
    float level;           // of the light, now
    float level_at_start;  // and when the phase began
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots. The simulator overrides them from the configuration file.
uint32_t run_duration_min = 200;      // ms
uint32_t run_duration_max = 1200;     // ms
uint32_t tumble_duration_min = 100;   // ms
uint32_t tumble_duration_max = 1100;  // ms
uint16_t dark_threshold = 210;        // sensor counts; search below, climb above
uint8_t uphill_factor = 3;            // search runs that lead to more light last this many times longer

static uint32_t random_between(uint32_t low, uint32_t high) {
    return high > low ? low + (uint32_t)rand() % (high - low + 1) : low;
}

static void set_motors(uint16_t left, uint16_t right) {
    pogobot_motor_set(motorL, left);
    pogobot_motor_set(motorR, right);
}

// The plane through the three readings: its height in the middle of the sensors and its slope.
static light_t look_around(void) {
    float const back = pogobot_photosensors_read(p_B);
    float const left = pogobot_photosensors_read(p_FL);
    float const right = pogobot_photosensors_read(p_FR);
    light_t const light = {.level = (back + left + right) / 3.0f,
                           .forward = ((left + right) / 2.0f - back) / (COS_40 + 1.0f),
                           .right = (right - left) / (2.0f * SIN_40)};
    return light;
}

static void start_phase(phase_t phase, uint32_t duration_ms) {
    mydata->phase = phase;
    mydata->phase_start_ms = current_time_milliseconds();
    mydata->phase_duration_ms = duration_ms;
    mydata->level_at_start = mydata->level;
}

static void start_run(void) {
    start_phase(PHASE_RUN, random_between(run_duration_min, run_duration_max));
    pogobot_led_setColor(0, 255, 0);
    set_motors(motorFull, motorFull);
}

static void start_tumble(void) {
    start_phase(PHASE_TUMBLE, random_between(tumble_duration_min, tumble_duration_max));
    pogobot_led_setColor(255, 0, 0);
    bool const to_left = rand() % 2 == 0;
    set_motors(to_left ? motorStop : motorFull, to_left ? motorFull : motorStop);
}

static void search(void) {
    if (mydata->phase == PHASE_CLIMB) {
        start_run();  // the light was just here
        return;
    }
    uint32_t duration_ms = mydata->phase_duration_ms;
    if (mydata->phase == PHASE_RUN && mydata->level > mydata->level_at_start) {
        duration_ms *= uphill_factor;
    }
    if (current_time_milliseconds() - mydata->phase_start_ms < duration_ms) {
        return;
    }
    if (mydata->phase == PHASE_RUN) {
        start_tumble();
    } else {
        start_run();
    }
}

static float absolute(float x) {
    return x < 0.0f ? -x : x;
}

static void climb(light_t light) {
    if (mydata->phase != PHASE_CLIMB) {
        start_phase(PHASE_CLIMB, 0);
        pogobot_led_setColor(255, 255, 0);
    }
    // -1: turn left about the left wheel, 0: straight ahead, 1: turn right about the right wheel.
    float turn = 0.0f;
    if (light.forward < 0.0f) {
        turn = light.right < 0.0f ? -1.0f : 1.0f;
    } else if (light.right != 0.0f) {
        turn = light.right / (light.forward + absolute(light.right));
    }
    float const slower = (float)motorFull * (1.0f - absolute(turn));
    if (turn < 0.0f) {
        set_motors((uint16_t)slower, motorFull);
    } else {
        set_motors(motorFull, (uint16_t)slower);
    }
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    // Forwards, as this robot is calibrated; it never drives backwards.
    uint8_t forward_dir[3];  // right, left, back
    pogobot_motor_dir_mem_get(forward_dir);
    pogobot_motor_dir_set(motorR, forward_dir[0]);
    pogobot_motor_dir_set(motorL, forward_dir[1]);
    mydata->level = look_around().level;
    start_tumble();
}

void user_step(void) {
    light_t const light = look_around();
    mydata->level = light.level;
    if (light.level > (float)dark_threshold) {
        climb(light);
    } else {
        search();
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
    init_from_configuration(dark_threshold);
    init_from_configuration(uphill_factor);
}

static void create_data_schema(void) {
    data_add_column_double("light");  // mean of the robot's sensors
    data_add_column_int8("phase");    // 0 run, 1 tumble, 2 climb
}

static void export_data(void) {
    data_set_value_double("light", mydata->level);
    data_set_value_int8("phase", mydata->phase);
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
