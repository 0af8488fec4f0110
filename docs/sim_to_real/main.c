// A robot whose policy is learnt in Python and compiled into its firmware, for docs/sim_to_real.md.
//
// While the policy is learnt, Python reads what this program makes of the sensors, and writes the powers of the motors.
// Once `pogosim export-policy` has written policy.h, the same program decides itself, here and on real robots. Without
// that file, robots that no host commands rest.
#include "pogobase.h"

#if __has_include("policy.h")
#include "policy.h"
#define HAS_POLICY 1
#else
#define HAS_POLICY 0
#endif

typedef struct {
    int32_t light;           // mean of the three photosensors, sensor counts
    int32_t ahead;           // how much brighter it is in front than behind, sensor counts
    int32_t right;           // how much brighter it is on the right than on the left, sensor counts
    int32_t motor_right;     // power of a motor, -1023 to 1023
    int32_t motor_left;      // likewise
    bool is_right;           // the policy computes what it did when it was exported
    uint8_t forward_dir[3];  // calibration of this robot: direction bits [right, left, back]
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

bool is_commanded = false;  // a parameter: a host writes the powers of the motors

static void observe(void) {
    int32_t const back = pogobot_photosensors_read(p_B);
    int32_t const left = pogobot_photosensors_read(p_FL);
    int32_t const right = pogobot_photosensors_read(p_FR);
    mydata->light = (back + left + right) / 3;
    mydata->ahead = (left + right) / 2 - back;
    mydata->right = right - left;
}

static void decide(void) {
#if HAS_POLICY
    policy_value_t inputs[POLICY_INPUTS];
    policy_value_t outputs[POLICY_OUTPUTS];
    inputs[POLICY_INPUT_USER_DATA_LIGHT] = mydata->light;
    inputs[POLICY_INPUT_USER_DATA_AHEAD] = mydata->ahead;
    inputs[POLICY_INPUT_USER_DATA_RIGHT] = mydata->right;
    policy_step(inputs, outputs);
    mydata->motor_right = outputs[POLICY_OUTPUT_USER_DATA_MOTOR_RIGHT];
    mydata->motor_left = outputs[POLICY_OUTPUT_USER_DATA_MOTOR_LEFT];
#endif
}

static void drive(motor_id motor, uint8_t forward_dir, int32_t power) {
    pogobot_motor_dir_set(motor, power < 0 ? 1 - forward_dir : forward_dir);
    pogobot_motor_set(motor, (uint16_t)(power < 0 ? -power : power));
}

void user_init(void) {
    main_loop_hz = 60;
    pogobot_motor_dir_mem_get(mydata->forward_dir);
    mydata->is_right = true;
#if HAS_POLICY
    mydata->is_right = policy_self_test();
#endif
    observe();
}

void user_step(void) {
    observe();
    if (!is_commanded) {
        decide();
    }
    drive(motorR, mydata->forward_dir[0], mydata->motor_right);
    drive(motorL, mydata->forward_dir[1], mydata->motor_left);
    pogobot_led_setColor(mydata->is_right ? 0 : 255, mydata->is_right ? 25 : 0, 0);  // red: not what was exported
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(is_commanded);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}
