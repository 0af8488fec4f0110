// Avoid walls: robots drive around and turn away from whatever announces that it is in the way.
//
// Shows: several controllers in one program, the ready-made controller of walls, which face of a robot has heard a
// message.
//
// The walls of the arena run `default_walls_user_init` and `default_walls_user_step`, which keep sending "wall".
// Objects that can be pushed (`active_objects`) keep sending "OBJECT". A robot that hears one of them turns away from
// the face that has heard it (red), then drives straight ahead for a while whatever it hears (yellow), so that it
// leaves corners, and then drives freely (green).
//
//     ./examples/avoid_walls/avoid_walls -c conf/active_objects.yaml
#include "pogobase.h"

typedef enum { FREE, TURN, COMMIT } phase_t;

typedef struct USERDATA {
    phase_t phase;
    uint32_t phase_end_ms;
    uint32_t heard_ms;   // when something in the way was heard last
    uint8_t heard_face;  // by which face: ir_front, ir_right, ir_back or ir_left
    bool has_heard;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots. The simulator overrides them from the configuration file.
uint32_t wall_memory_ms = 100;      // what was heard longer ago is forgotten
uint32_t turn_duration_ms = 300;    // of turning away
uint32_t forward_commit_ms = 1000;  // of driving straight ahead afterwards
float forward_speed_ratio = 1.0f;   // of full speed

static uint8_t const object_text[] = "OBJECT";

/* ---- robots ---- */

static void set_motors(uint16_t left, uint16_t right) {
    pogobot_motor_set(motorL, left);
    pogobot_motor_set(motorR, right);
}

static void drive_forward(void) {
    uint16_t const power = (uint16_t)(forward_speed_ratio * motorFull);
    set_motors(power, power);
}

// To the other side of what was heard; from something straight ahead or behind, to either side.
static void turn_away(uint8_t face) {
    bool const to_right = face == ir_left || (face != ir_right && rand() % 2 == 0);
    set_motors(to_right ? motorFull : motorStop, to_right ? motorStop : motorFull);
}

static void enter(phase_t phase, uint32_t now_ms) {
    mydata->phase = phase;
    if (phase == TURN) {
        mydata->phase_end_ms = now_ms + turn_duration_ms;
        pogobot_led_setColor(25, 0, 0);
        turn_away(mydata->heard_face);
    } else {
        mydata->phase_end_ms = now_ms + forward_commit_ms;
        pogobot_led_setColor(phase == COMMIT ? 25 : 0, 25, 0);
        drive_forward();
    }
}

static bool starts_with(message_t const* message, void const* text, size_t size) {
    return message->header.payload_length >= size && memcmp(message->payload, text, size) == 0;
}

static void robot_receive(message_t* message) {
    if (starts_with(message, "wall", 4) || starts_with(message, object_text, 6)) {
        mydata->has_heard = true;
        mydata->heard_ms = current_time_milliseconds();
        mydata->heard_face = message->header._receiver_ir_index;
    }
}

static void robot_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = 10;
    msg_rx_fn = robot_receive;
    enter(FREE, current_time_milliseconds());
}

static void robot_step(void) {
    uint32_t const now_ms = current_time_milliseconds();
    bool const is_over = now_ms >= mydata->phase_end_ms;
    bool const remembers = mydata->has_heard && now_ms - mydata->heard_ms <= wall_memory_ms;
    // What it hears with its back is behind it already.
    bool const is_in_the_way = remembers && mydata->heard_face != ir_back;
    if (mydata->phase == TURN && is_over) {
        enter(is_in_the_way ? TURN : COMMIT, now_ms);
    } else if (mydata->phase == COMMIT && is_over) {
        enter(FREE, now_ms);
    } else if (mydata->phase == FREE && is_in_the_way) {
        enter(TURN, now_ms);
    }
}

/* ---- objects ---- */

static bool object_send(void) {
    uint8_t message[sizeof(object_text)];
    memcpy(message, object_text, sizeof(object_text));
    return pogobot_infrared_sendLongMessage_omniGen(message, sizeof(message)) == 0;
}

static void object_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 10;
    percent_msgs_sent_per_ticks = 75;
    max_nb_processed_msg_per_tick = 0;
    msg_tx_fn = object_send;
    pogobot_led_setColor(0, 0, 25);
}

static void object_step(void) {}

#ifdef SIMULATOR
#define MAX_DURATION_MS 10000000  // nearly three hours

// Called once, before the robots start.
static void global_setup(void) {
    init_from_configuration(wall_memory_ms);
    check_parameter(wall_memory_ms, 0, MAX_DURATION_MS);
    init_from_configuration(turn_duration_ms);
    check_parameter(turn_duration_ms, 0, MAX_DURATION_MS);
    init_from_configuration(forward_commit_ms);
    check_parameter(forward_commit_ms, 0, MAX_DURATION_MS);
    init_from_configuration(forward_speed_ratio);
    check_parameter(forward_speed_ratio, 0, 1);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(robot_init, robot_step, "robots");
    pogobot_start(object_init, object_step, "active_objects");
    pogobot_start(default_walls_user_init, default_walls_user_step, "walls");
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}
