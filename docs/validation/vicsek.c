// The model of Vicsek et al. (Physical Review Letters 75, 1226, 1995) to the letter: points that all move at once.
//
// In a step of the model, each robot moves straight ahead, and then heads where it and all robots within its range were
// heading on average before it moved, plus an error drawn uniformly from -noise_eta / 2 to noise_eta / 2. A step takes
// two ticks: in the first, robots stand and tell each other their headings; in the second, they move and turn.
// Robots start in parallel, so they know their headings from the turns they have made.
#include <math.h>

#include "pogobase.h"

#define PI 3.14159265f
#define CRUISE_POWER 100  // of both motors; what is left turns the robot
#define MAX_ROBOTS 512

typedef struct {
    uint16_t id;
    float heading;
} content_t;

typedef struct {
    float heading;          // rad, exactly that of the body
    float angle_per_power;  // rad turned in a tick, for one unit of power more on the left and one less on the right
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
float noise_eta = 0.0f;          // rad, 0 to 2 pi
float max_angular_speed = 9.0f;  // rad/s, as in the configuration of the robots

static float uniform(float low, float high) {
    return low + (high - low) * ((float)rand() + 0.5f) / ((float)RAND_MAX + 1.0f);
}

// Drives for a tick, which ends with the heading changed by an angle.
static void drive(int cruise, float angle) {
    int const turn = (int)roundf(remainderf(angle, 2.0f * PI) / mydata->angle_per_power);
    int const left = cruise + turn, right = cruise - turn;
    pogobot_motor_dir_set(motorL, left >= 0 ? 1 : 0);
    pogobot_motor_dir_set(motorR, right >= 0 ? 0 : 1);
    pogobot_motor_set(motorL, (uint16_t)abs(left));
    pogobot_motor_set(motorR, (uint16_t)abs(right));
    mydata->heading = remainderf(mydata->heading + (float)turn * mydata->angle_per_power, 2.0f * PI);
}

static void tell_heading(void) {
    content_t content = {.id = pogobot_helper_getid(), .heading = mydata->heading};
    pogobot_infrared_sendShortMessage_omni((uint8_t*)&content, sizeof(content));
}

// Mean direction of all that were heard and of the robot itself. A message comes once for each face that it reaches.
static float mean_heading(void) {
    bool heard[MAX_ROBOTS] = {false};
    float x = cosf(mydata->heading), y = sinf(mydata->heading);
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t message;
        content_t content;
        pogobot_infrared_recover_next_message(&message);
        memcpy(&content, message.payload, sizeof(content));
        if (content.id < MAX_ROBOTS && !heard[content.id]) {
            heard[content.id] = true;
            x += cosf(content.heading);
            y += sinf(content.heading);
        }
    }
    return atan2f(y, x);
}

void user_init(void) {
    // A seed has 16 bits: with two of them, no two robots of many runs draw the same numbers.
    srand((uint32_t)pogobot_helper_getRandSeed() << 16 ^ (uint16_t)pogobot_helper_getRandSeed());
    main_loop_hz = 10;
    mydata->angle_per_power = 2.0f * max_angular_speed / 511.5f / main_loop_hz;
    mydata->heading = PI / 2.0f;  // of formations with names that begin with aligned_
}

void user_step(void) {
    if (pogobot_ticks == 0) {
        drive(0, uniform(-PI, PI));
    } else if (pogobot_ticks % 2 == 1) {
        drive(0, 0.0f);
        tell_heading();
    } else {
        float const noise = uniform(-noise_eta / 2.0f, noise_eta / 2.0f);
        drive(CRUISE_POWER, mean_heading() + noise - mydata->heading);
    }
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(noise_eta);
    check_parameter(noise_eta, 0, 6.2832);
    init_from_configuration(max_angular_speed);
}

static void create_data_schema(void) {
    data_add_column_double("heading");
}

static void export_data(void) {
    data_set_value_double("heading", mydata->heading);
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
