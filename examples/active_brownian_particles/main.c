// Active Brownian particles: swimmers of constant speed whose heading diffuses.
//
// Shows: a model of physics as a robot's program; the gyroscope and the accelerometer tell a robot that it is stuck.
//
// A particle moves at speed v along its heading, and the heading makes a random walk with diffusion coefficient D_r.
// Its mean squared displacement in the plane is then
//
//     MSD(t) = 2 v^2 / D_r^2 (D_r t - 1 + exp(-D_r t)),
//
// (v t)^2 at first and 2 v^2 t / D_r after many times 1 / D_r (Howse et al., "Self-motile colloidal particles: from
// directed propulsion to random walk", Phys. Rev. Lett. 99, 048102, 2007; Romanczuk et al., "Active Brownian
// particles", Eur. Phys. J. Spec. Top. 202, 2012).
//
// A robot cannot turn as suddenly as white noise. So it turns at a constant rate w, whose sign it redraws after each
// time T. With w^2 T = 2 D_r the mean squared displacement is exactly the same after long times, and nearly the same
// before, the closer the shorter T is. T is as short as the robot's wheels allow, a tick or more.
//
// Particles that push against a wall stay there for a time 1 / D_r or so. Robots need not: one that feels, with its
// IMU, that it does not move as it should (red), drives back a little, spins (blue), and swims on (green).
//
//     ./examples/active_brownian_particles/active_brownian_particles -c conf/active_brownian_particles.yaml
#include "pogobase.h"

#define CRUISE_POWER motorHalf     // of both motors: leaves as much room for turning as possible
#define VELOCITY_MEMORY_S 1.0f     // for so long the accelerometer, which drifts, counts more than the motors
#define VELOCITY_SMOOTHING_S 0.1f  // longer than bounces off a wall last
#define MAX_TICKS_A_TURN 10000

typedef enum { PHASE_SWIM, PHASE_REVERSE, PHASE_SPIN } phase_t;

typedef struct {
    phase_t phase;
    uint32_t phase_start_ms;
    uint32_t phase_duration_ms;
    uint8_t forward_dir[3];  // calibration of this robot: direction bits [right, left, back] that drive it forward

    float tick_s;           // from one tick to the next
    uint16_t ticks_a_turn;  // T
    int16_t turn_power;     // more on one motor, less on the other: turns the robot at the rate w

    float velocity_forward, velocity_right;  // as the IMU feels it, m/s
    float commanded;                         // forward, as the motors were set, m/s
    float smooth_forward;                    // velocity_forward without its jitter, m/s
    uint32_t slow_since_ms;                  // when it was last as fast as it should be
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots. The simulator overrides them from the configuration file.
float rotational_diffusion = 1.4f;  // D_r, rad^2/s
float max_linear_speed = 100.0f;    // mm/s, of this kind of robot with both motors at full power
float max_angular_speed = 2.0f;     // rad/s; one motor alone at full power turns it at twice this rate
uint32_t stuck_duration = 300;      // ms below half the speed after which a robot counts as stuck
uint32_t reverse_duration = 400;    // ms
uint32_t spin_duration_min = 100;   // ms
uint32_t spin_duration_max = 500;   // ms

static uint32_t random_between(uint32_t low, uint32_t high) {
    return high > low ? low + (uint32_t)rand() % (high - low + 1) : low;
}

// Newton's method: robots have no mathematical library.
static float square_root(float x) {
    float root = x > 1.0f ? x : 1.0f;
    for (int i = 0; i < 30; i++) {
        root = 0.5f * (root + x / root);
    }
    return root;
}

static void set_motor(motor_id motor, int16_t power, uint8_t forward_bit) {
    pogobot_motor_dir_set(motor, power < 0 ? forward_bit ^ 1 : forward_bit);
    pogobot_motor_set(motor, (uint16_t)(power < 0 ? -power : power));
}

// Powers of -1023 to 1023.
static void drive(int16_t left, int16_t right) {
    set_motor(motorL, left, mydata->forward_dir[1]);
    set_motor(motorR, right, mydata->forward_dir[0]);
    mydata->commanded = max_linear_speed / 1000.0f * (float)(left + right) / (2.0f * motorFull);
}

static int16_t random_sign(void) {
    return rand() % 2 == 0 ? -1 : 1;
}

// Chooses T and w: w^2 T = 2 D_r, with w as large as the motors allow.
static void plan_turns(void) {
    float const rate_of_full_power = 4.0f * max_angular_speed;  // rad/s, both motors, in opposite directions
    float const highest_rate = rate_of_full_power * (motorFull - CRUISE_POWER) / motorFull;
    float const ticks = 2.0f * rotational_diffusion / (highest_rate * highest_rate * mydata->tick_s);
    mydata->ticks_a_turn = ticks < MAX_TICKS_A_TURN ? (uint16_t)(1.0f + ticks) : MAX_TICKS_A_TURN;
    float const turn_s = (float)mydata->ticks_a_turn * mydata->tick_s;
    float const rate = square_root(2.0f * rotational_diffusion / turn_s);
    mydata->turn_power = (int16_t)(motorFull * rate / rate_of_full_power + 0.5f);
}

static void start_phase(phase_t phase, uint32_t duration_ms) {
    mydata->phase = phase;
    mydata->phase_start_ms = current_time_milliseconds();
    mydata->phase_duration_ms = duration_ms;
}

static void start_swimming(void) {
    start_phase(PHASE_SWIM, 0);
    mydata->slow_since_ms = mydata->phase_start_ms;
    pogobot_led_setColor(0, 255, 0);
}

static void start_reversing(void) {
    start_phase(PHASE_REVERSE, reverse_duration);
    pogobot_led_setColor(255, 0, 0);
    drive(-CRUISE_POWER, -CRUISE_POWER);
}

static void start_spinning(void) {
    start_phase(PHASE_SPIN, random_between(spin_duration_min, spin_duration_max));
    pogobot_led_setColor(0, 0, 255);
    int16_t const power = (int16_t)(random_sign() * motorFull);
    drive(power, (int16_t)-power);
}

// Integrates accelerations to a velocity in the robot's frame, which slowly relaxes to the one that the motors command
// (a complementary filter).
static void feel_velocity(void) {
    float acc[3], gyro[3];
    pogobot_imu_read(acc, gyro);
    // The frame has turned by a small angle to the right; the velocity has not.
    float const sine = -gyro[2] * mydata->tick_s;
    float const cosine = 1.0f - sine * sine / 2.0f;
    float const forward = cosine * mydata->velocity_forward + sine * mydata->velocity_right + acc[1] * mydata->tick_s;
    float const right = cosine * mydata->velocity_right - sine * mydata->velocity_forward + acc[0] * mydata->tick_s;
    float const forget = mydata->tick_s / VELOCITY_MEMORY_S;
    mydata->velocity_forward = forward + forget * (mydata->commanded - forward);
    mydata->velocity_right = right - forget * right;
    mydata->smooth_forward +=
        mydata->tick_s / VELOCITY_SMOOTHING_S * (mydata->velocity_forward - mydata->smooth_forward);
}

static bool is_stuck(void) {
    uint32_t const now_ms = current_time_milliseconds();
    if (mydata->smooth_forward >= 0.5f * mydata->commanded) {
        mydata->slow_since_ms = now_ms;
    }
    return now_ms - mydata->slow_since_ms >= stuck_duration;
}

static void swim(void) {
    if (pogobot_ticks % mydata->ticks_a_turn == 0) {
        int16_t const turn = (int16_t)(random_sign() * mydata->turn_power);
        drive((int16_t)(CRUISE_POWER + turn), (int16_t)(CRUISE_POWER - turn));
    }
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    mydata->tick_s = (float)(1000 / main_loop_hz) / 1000.0f;  // robots sleep whole milliseconds
    pogobot_motor_dir_mem_get(mydata->forward_dir);
    plan_turns();
    start_swimming();
}

void user_step(void) {
    feel_velocity();
    bool const over = current_time_milliseconds() - mydata->phase_start_ms >= mydata->phase_duration_ms;
    switch (mydata->phase) {
        case PHASE_SWIM:
            swim();
            if (is_stuck()) {
                start_reversing();
            }
            break;
        case PHASE_REVERSE:
            if (over) {
                start_spinning();
            }
            break;
        case PHASE_SPIN:
            if (over) {
                drive(CRUISE_POWER, CRUISE_POWER);
                start_swimming();
            }
            break;
    }
}

#ifdef SIMULATOR
#define MAX_DURATION_MS 10000000  // nearly three hours

static void global_setup(void) {
    init_from_configuration(rotational_diffusion);
    check_parameter(rotational_diffusion, 0, 100);
    init_from_configuration(max_linear_speed);
    check_parameter(max_linear_speed, 0, 1e6);
    init_from_configuration(max_angular_speed);
    check_parameter(max_angular_speed, 0.01, 100);
    init_from_configuration(stuck_duration);
    check_parameter(stuck_duration, 0, MAX_DURATION_MS);
    init_from_configuration(reverse_duration);
    check_parameter(reverse_duration, 0, MAX_DURATION_MS);
    init_from_configuration(spin_duration_min);
    check_parameter(spin_duration_min, 0, MAX_DURATION_MS);
    init_from_configuration(spin_duration_max);
    check_parameter(spin_duration_max, 0, MAX_DURATION_MS);
}

static void create_data_schema(void) {
    data_add_column_int8("phase");               // 0 swim, 1 reverse, 2 spin
    data_add_column_double("velocity_forward");  // as the IMU feels it, m/s
}

static void export_data(void) {
    data_set_value_int8("phase", mydata->phase);
    data_set_value_double("velocity_forward", mydata->velocity_forward);
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
