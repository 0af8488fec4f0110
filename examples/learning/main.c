// Learning: robots whose motors follow a policy that Python has learnt, or that it is learning now.
//
// Shows: USERDATA as the place where a robot and Python meet, a list of numbers as a parameter.
//
// A robot makes a few numbers of what it senses, its observation: how bright it is, to which side it gets brighter, and
// how many messages come from each side. A policy makes an action of them, the power of its two motors. While it is
// learnt, that happens in Python, reading `observation` and writing `action` (environments.py, train.py);
// docs/learning.md explains it. What has been learnt is a list of weights, with which the robots, real ones, too, do
// without Python. The weights below steer towards light, like vehicle 2b of Braitenberg's "Vehicles", 1984.
//
//     ./examples/learning/learning -c conf/learning.yaml
#include "pogobase.h"

#define OBSERVATION_COUNT 7  // light, light ahead, light to the right, neighbours at each of the four faces
#define ACTION_COUNT 2       // right motor, left motor, as pogobot_motor_* and hosts have them

typedef struct {
    float observation[OBSERVATION_COUNT];  // each from -1 to 1
    float action[ACTION_COUNT];            // -1: full power backwards, 0: stop, 1: full power forwards
    float messages[IR_RX_COUNT];           // received by each face, old ones forgotten
    uint8_t forward_dir[3];                // calibration of this robot: direction bits [right, left, back]
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots. The simulator overrides them from the configuration file.
bool is_commanded = false;  // a host writes the actions
// For each motor a bias and the weights of the observation; the action is their sum.
float policy[ACTION_COUNT * (1 + OBSERVATION_COUNT)] = {0.5f, 0, 0, -1, 0, 0, 0, 0,   // right
                                                        0.5f, 0, 0, 1,  0, 0, 0, 0};  // left

#define LIGHT_SCALE 32767.0f   // the brightest that sensors can tell, sensor counts
#define CONTRAST_GAIN 10.0f    // a tenth more light on one side counts 1
#define FORGET_PER_TICK 0.95f  // messages of the last 0.3 s count

static float clamped(float x) {
    return x < -1.0f ? -1.0f : x > 1.0f ? 1.0f : x;
}

static float contrast(float here, float there) {
    return clamped(CONTRAST_GAIN * (here - there) / (here + there + 1.0f));
}

static void observe(void) {
    float const back = pogobot_photosensors_read(p_B);
    float const left = pogobot_photosensors_read(p_FL);
    float const right = pogobot_photosensors_read(p_FR);
    mydata->observation[0] = clamped((back + left + right) / (3.0f * LIGHT_SCALE));
    mydata->observation[1] = contrast((left + right) / 2.0f, back);
    mydata->observation[2] = contrast(right, left);
    for (uint8_t face = 0; face < IR_RX_COUNT; face++) {
        // A neighbour gives about 4 messages; each further one adds less.
        mydata->observation[3 + face] = mydata->messages[face] / (mydata->messages[face] + 4.0f);
        mydata->messages[face] *= FORGET_PER_TICK;
    }
}

static void decide(void) {
    for (uint8_t i = 0; i < ACTION_COUNT; i++) {
        float const* const weights = &policy[i * (1 + OBSERVATION_COUNT)];
        float sum = weights[0];
        for (uint8_t j = 0; j < OBSERVATION_COUNT; j++) {
            sum += weights[1 + j] * mydata->observation[j];
        }
        mydata->action[i] = sum;
    }
}

static void drive(motor_id motor, uint8_t forward_dir, float action) {
    float const power = clamped(action);
    pogobot_motor_dir_set(motor, power < 0.0f ? 1 - forward_dir : forward_dir);
    pogobot_motor_set(motor, (uint16_t)((float)motorFull * (power < 0.0f ? -power : power)));
}

static bool send_message(void) {
    uint8_t const here = 1;
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&here, sizeof(here)) == 0;
}

static void process_message(message_t* message) {
    mydata->messages[message->header._receiver_ir_index] += 1.0f;
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = 10;
    percent_msgs_sent_per_ticks = 20;
    msg_tx_fn = send_message;
    msg_rx_fn = process_message;
    pogobot_motor_dir_mem_get(mydata->forward_dir);
    observe();
}

void user_step(void) {
    observe();
    if (!is_commanded) {
        decide();
    }
    drive(motorR, mydata->forward_dir[0], mydata->action[0]);
    drive(motorL, mydata->forward_dir[1], mydata->action[1]);
    // Yellow: light, blue: neighbours.
    float const* const heard = &mydata->observation[3];
    float const neighbours = heard[ir_front] + heard[ir_right] + heard[ir_back] + heard[ir_left];
    uint8_t const light = (uint8_t)(255.0f * mydata->observation[0]);
    pogobot_led_setColor(light, light, (uint8_t)(60.0f * neighbours));
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(is_commanded);
    init_array_from_configuration(policy);
}

static void create_data_schema(void) {
    data_add_column_float("light");
}

static void export_data(void) {
    data_set_value_float("light", mydata->observation[0]);
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
