// A policy: a small neural network drives robots to light.
//
// Shows: a policy that Python has learnt, exported as C in whole numbers; its self test.
//
// learn.py learns the network, phototaxis.npz, and `pogosim export-policy` makes policy.h of it;
// docs/policy_export.md explains both. The network sees the mean of the three photosensors, how much brighter it
// is ahead and to the right, and says the power of both motors. It has no memory. The head LED is red if the robot
// computes something else than the network that was exported, and else as bright as the light.
//
//     ./examples/policy/policy -c conf/policy.yaml
#include "pogobase.h"
#include "policy.h"

typedef struct {
    policy_value_t inputs[POLICY_INPUTS];  // sensor counts
    bool is_right;                         // the self test has passed
    uint8_t forward_dir[3];                // calibration of this robot: direction bits [right, left, back]
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

static void observe(void) {
    int32_t const back = pogobot_photosensors_read(p_B);
    int32_t const left = pogobot_photosensors_read(p_FL);
    int32_t const right = pogobot_photosensors_read(p_FR);
    mydata->inputs[POLICY_INPUT_LIGHT] = (back + left + right) / 3;
    mydata->inputs[POLICY_INPUT_AHEAD] = (left + right) / 2 - back;
    mydata->inputs[POLICY_INPUT_RIGHT] = right - left;
}

static void drive(motor_id motor, uint8_t forward_dir, int32_t power) {
    pogobot_motor_dir_set(motor, power < 0 ? 1 - forward_dir : forward_dir);
    pogobot_motor_set(motor, (uint16_t)(power < 0 ? -power : power));
}

void user_init(void) {
    main_loop_hz = 60;
    pogobot_motor_dir_mem_get(mydata->forward_dir);
    mydata->is_right = policy_self_test();
}

void user_step(void) {
    policy_value_t outputs[POLICY_OUTPUTS];
    observe();
    policy_step(mydata->inputs, outputs);
    drive(motorR, mydata->forward_dir[0], outputs[POLICY_OUTPUT_MOTOR_RIGHT]);
    drive(motorL, mydata->forward_dir[1], outputs[POLICY_OUTPUT_MOTOR_LEFT]);
    uint8_t const brightness = (uint8_t)(mydata->inputs[POLICY_INPUT_LIGHT] / 128);
    pogobot_led_setColor(mydata->is_right ? brightness : 255, mydata->is_right ? brightness : 0, 0);
}

#ifdef SIMULATOR
static void create_data_schema(void) {
    data_add_column_int32("light");
    data_add_column_int32("ahead");
    data_add_column_int32("right");
}

// Observations of a run: the ranges of the inputs come from such columns.
static void export_data(void) {
    data_set_value_int32("light", mydata->inputs[POLICY_INPUT_LIGHT]);
    data_set_value_int32("ahead", mydata->inputs[POLICY_INPUT_AHEAD]);
    data_set_value_int32("right", mydata->inputs[POLICY_INPUT_RIGHT]);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
