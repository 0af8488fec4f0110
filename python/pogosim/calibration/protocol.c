// What robots run while they are filmed for `pogosim calibrate`: straight on, to the left, to the right, a rest, again
// and again. The same file compiles for real robots (`make bin`) and for the simulator, which runs it as well.
//
// Each phase shows something of its own: straight on, the speed and the bias; the turns, the turning speed; the rest,
// the noise of the camera. The turn to the left takes longer than the one to the right, so that robots do not keep
// their heading, and so that a mirrored film can be told.
#include "pogobase.h"

typedef struct {
    uint8_t forward_dir[3];  // calibration of this robot: direction bits [right, left, back] that drive it forward
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

#define STRAIGHT_MS 3000
#define LEFT_MS 3000
#define RIGHT_MS 2000
#define REST_MS 3000
#define CYCLE_MS (STRAIGHT_MS + LEFT_MS + RIGHT_MS + REST_MS)

static void drive(uint16_t left, uint16_t right) {
    pogobot_motor_set(motorL, left);
    pogobot_motor_set(motorR, right);
}

void user_init(void) {
    main_loop_hz = 60;
    pogobot_motor_dir_mem_get(mydata->forward_dir);
    pogobot_motor_dir_set(motorR, mydata->forward_dir[0]);
    pogobot_motor_dir_set(motorL, mydata->forward_dir[1]);
}

void user_step(void) {
    uint32_t const phase_ms = current_time_milliseconds() % CYCLE_MS;
    if (phase_ms < STRAIGHT_MS) {
        drive(motorFull, motorFull);
        pogobot_led_setColor(0, 25, 0);
    } else if (phase_ms < STRAIGHT_MS + LEFT_MS) {
        drive(motorStop, motorFull);
        pogobot_led_setColor(25, 0, 0);
    } else if (phase_ms < STRAIGHT_MS + LEFT_MS + RIGHT_MS) {
        drive(motorFull, motorStop);
        pogobot_led_setColor(0, 0, 25);
    } else {
        drive(motorStop, motorStop);
        pogobot_led_setColor(0, 0, 0);
    }
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
