// Kuramoto's oscillators (Y. Kuramoto, 1975): each robot is a clock, pulled towards the phases that it hears.
//
//     d theta / dt = w + K * mean over all phases heard in a tick of sin(theta_j - theta)
//
// The frequencies w are the quantiles (i + 1/2) / N of a Lorentzian distribution around 0 of half-width gamma, for the
// robots i = 0 to N - 1. With a range beyond the arena, all robots hear each other, as in the theory; with a short one,
// robots that drive about hear ever new ones.
#include <math.h>

#include "pogobase.h"

#define PI 3.14159265f
#define MAX_ROBOTS 512

typedef struct {
    uint16_t id;
    float theta;
} content_t;

typedef struct {
    float theta;      // rad
    float frequency;  // rad/s
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
float coupling_k = 1.0f;    // rad/s
float gamma_width = 0.5f;   // rad/s
float nb_robots = 100.0f;   // as in the configuration
uint16_t cruise_power = 0;  // of both motors; 0: robots stand
uint8_t send_percent = 10;  // chance to send in a tick

static float uniform(float low, float high) {
    return low + (high - low) * ((float)rand() + 0.5f) / ((float)RAND_MAX + 1.0f);
}

static bool send_phase(void) {
    content_t content = {.id = pogobot_helper_getid(), .theta = mydata->theta};
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&content, sizeof(content)) == 0;
}

// Mean of sin(theta_j - theta) over all robots heard since the last tick. A message comes once per face it reaches.
static float mean_pull(void) {
    bool heard[MAX_ROBOTS] = {false};
    float sum = 0.0f;
    int count = 0;
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t message;
        content_t content;
        pogobot_infrared_recover_next_message(&message);
        memcpy(&content, message.payload, sizeof(content));
        if (content.id < MAX_ROBOTS && !heard[content.id]) {
            heard[content.id] = true;
            sum += sinf(content.theta - mydata->theta);
            count++;
        }
    }
    return count > 0 ? sum / (float)count : 0.0f;
}

static void drive_about(void) {
    int const turn = (int)uniform(-0.5f * cruise_power, 0.5f * cruise_power);
    pogobot_motor_set(motorL, (uint16_t)(cruise_power + turn));
    pogobot_motor_set(motorR, (uint16_t)(cruise_power - turn));
}

void user_init(void) {
    // A seed has 16 bits: with two of them, no two robots of many runs draw the same numbers.
    srand((uint32_t)pogobot_helper_getRandSeed() << 16 ^ (uint16_t)pogobot_helper_getRandSeed());
    main_loop_hz = 10;
    percent_msgs_sent_per_ticks = send_percent;
    msg_tx_fn = send_phase;
    mydata->theta = uniform(-PI, PI);
    float const quantile = ((float)pogobot_helper_getid() + 0.5f) / nb_robots;
    mydata->frequency = gamma_width * tanf(PI * (quantile - 0.5f));
}

void user_step(void) {
    float const rate = mydata->frequency + coupling_k * mean_pull();
    mydata->theta = remainderf(mydata->theta + rate / main_loop_hz, 2.0f * PI);
    if (cruise_power > 0) {
        drive_about();
    }
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(coupling_k);
    init_from_configuration(gamma_width);
    init_from_configuration(nb_robots);
    init_from_configuration(cruise_power);
    init_from_configuration(send_percent);
}

static void create_data_schema(void) {
    data_add_column_double("theta");
}

static void export_data(void) {
    data_set_value_double("theta", mydata->theta);
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
