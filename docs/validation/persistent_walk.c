// A persistent random walk in its simplest form: constant speed, and random turns that nothing else disturbs.
//
// Two kinds of turns, together or alone:
//
//  - rotational diffusion (active Brownian particles): at each tick, a normal turn with the variance 2 D_r dt;
//  - tumbles (run and tumble): with the probability tumble_rate dt, a turn by tumble_angle to a random side, or in
//    any direction if tumble_angle is 0.
//
// A robot turns while it moves, within one tick, so runs have no pauses. In light, it may move more slowly
// (orthokinesis) or tumble more often (klinokinesis): by the shares slow_in_light and tumble_in_light at full light.
#include <math.h>

#include "pogobase.h"

#define PI 3.14159265f
#define CRUISE_POWER 100  // of both motors; what is left turns the robot
#define FULL_LIGHT 32767.0f

typedef struct {
    float tick_s;
    float angle_per_power;  // rad turned in a tick, for one unit of power more on the left and one less on the right
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
float max_angular_speed = 45.0f;    // rad/s, as in the configuration of the robots
float rotational_diffusion = 0.0f;  // D_r, rad^2/s
float tumble_rate = 0.0f;           // 1/s
float tumble_angle = 0.0f;          // rad
float slow_in_light = 0.0f;         // 0 to 1
float tumble_in_light = 0.0f;       // 0: as often as in the dark; 1: twice as often in full light

// Between 0 and 1, without both.
static float uniform(void) {
    return ((float)rand() + 0.5f) / ((float)RAND_MAX + 1.0f);
}

// Box and Muller's method.
static float standard_normal(void) {
    float const radius = sqrtf(-2.0f * logf(uniform()));
    return radius * cosf(2.0f * PI * uniform());
}

// 0 to 1, at the centre of the robot: mean of the three photosensors on its rim.
static float light(void) {
    float sum = 0.0f;
    for (uint8_t sensor = 0; sensor < 3; sensor++) {
        sum += pogobot_photosensors_read(sensor);
    }
    return sum / (3.0f * FULL_LIGHT);
}

static float random_turn(float brightness) {
    float turn = sqrtf(2.0f * rotational_diffusion * mydata->tick_s) * standard_normal();
    if (uniform() < tumble_rate * (1.0f + tumble_in_light * brightness) * mydata->tick_s) {
        float const side = uniform() < 0.5f ? -1.0f : 1.0f;
        turn += side * (tumble_angle > 0.0f ? tumble_angle : PI * uniform());
    }
    return remainderf(turn, 2.0f * PI);
}

void user_init(void) {
    // A seed has 16 bits: with two of them, no two robots of many runs walk alike.
    srand((uint32_t)pogobot_helper_getRandSeed() << 16 ^ (uint16_t)pogobot_helper_getRandSeed());
    main_loop_hz = 50;
    mydata->tick_s = 1.0f / main_loop_hz;
    mydata->angle_per_power = 2.0f * max_angular_speed / 511.5f * mydata->tick_s;
}

void user_step(void) {
    bool const sees = slow_in_light > 0.0f || tumble_in_light > 0.0f;
    float const brightness = sees ? light() : 0.0f;
    int const cruise = (int)(CRUISE_POWER * (1.0f - slow_in_light * brightness) + 0.5f);
    int const turn = (int)roundf(random_turn(brightness) / mydata->angle_per_power);
    int const left = cruise + turn, right = cruise - turn;
    pogobot_motor_dir_set(motorL, left >= 0 ? 1 : 0);
    pogobot_motor_dir_set(motorR, right >= 0 ? 0 : 1);
    pogobot_motor_set(motorL, (uint16_t)abs(left));
    pogobot_motor_set(motorR, (uint16_t)abs(right));
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(max_angular_speed);
    init_from_configuration(rotational_diffusion);
    init_from_configuration(tumble_rate);
    init_from_configuration(tumble_angle);
    init_from_configuration(slow_in_light);
    init_from_configuration(tumble_in_light);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}
