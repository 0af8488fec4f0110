// IMU: what a robot can feel of its own movement.
//
// Shows: reading gyroscope, accelerometer and thermometer, and checking them against the commands of the motors.
//
// A robot walks by run and tumble (green and red; see examples/run_and_tumble). At the end of each run and each tumble
// robot 0 prints what it measures, and a verdict: at the end of a run it should hardly turn, at the end of a tumble it
// should turn fast. "CHECK" instead of "OK" means that something else moved or held it, such as a neighbour or a wall.
//
//     ./examples/IMU/IMU -c conf/IMU.yaml
//
// conf/IMU.yaml has no damping, no noise, and a thermometer at 25 degrees. The axes are those of
// pogobot_imu_read(): x to the right, y forward, z up; turning counter-clockwise, seen from above, is positive.
#include "pogobase.h"

#define TURNING_RAD_S 2.0f  // turns faster than this count as turning

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

// Prints what the robot feels at the end of a phase.
static void report(void) {
    float acc[3], gyro[3];
    pogobot_imu_read(acc, gyro);
    bool const was_run = mydata->phase == PHASE_RUN;
    bool const turns = gyro[2] > TURNING_RAD_S || gyro[2] < -TURNING_RAD_S;
    printf("%s gyro: %.2f %.2f %.2f rad/s, acc: %.2f %.2f %.2f m/s2, temperature: %.1f C: %s\n",
           was_run ? "RUN" : "TUMBLE", (double)gyro[0], (double)gyro[1], (double)gyro[2], (double)acc[0],
           (double)acc[1], (double)acc[2], (double)pogobot_imu_readTemp(), turns == was_run ? "CHECK" : "OK");
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    pogobot_motor_dir_mem_get(mydata->forward_dir);
    mydata->phase_start_ms = current_time_milliseconds();
    start_tumble();
}

void user_step(void) {
    uint32_t const now_ms = current_time_milliseconds();
    if (now_ms - mydata->phase_start_ms < mydata->phase_duration_ms) {
        return;
    }
    mydata->phase_start_ms = now_ms;
    if (pogobot_helper_getid() == 0) {
        report();
    }
    if (mydata->phase == PHASE_RUN) {
        start_tumble();
    } else {
        start_run();
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
}

// What each robot feels, as columns of the data file.
static void create_data_schema(void) {
    data_add_column_double("gyro_z");     // rad/s
    data_add_column_double("acc_right");  // m/s2
    data_add_column_double("acc_forward");
    data_add_column_double("temperature");  // degrees Celsius
}

static void export_data(void) {
    float acc[3], gyro[3];
    pogobot_imu_read(acc, gyro);
    data_set_value_double("gyro_z", gyro[2]);
    data_set_value_double("acc_right", acc[0]);
    data_set_value_double("acc_forward", acc[1]);
    data_set_value_double("temperature", pogobot_imu_readTemp());
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
