// Walls: robots tell fixed walls from mobile ones.
//
// Three kinds of objects run this program, each with a controller of its own. The walls of the arena (`walls`, a
// pogowall) and soft rings (`membranes`) carry infrared emitters all along their outlines and keep saying what they
// are. Robots run and tumble, silent. One that hears a wall stops there and turns blue. One that hears a membrane turns
// yellow, and runs on, since a membrane is there to be pushed. In the end the robots outside membranes rest along
// the walls of the arena.
//
//     ./examples/walls/walls -c conf/walls_and_membranes.yaml
#include "pogobase.h"

typedef enum { RUN, TUMBLE, AT_WALL } phase_t;

typedef struct USERDATA {
    phase_t phase;
    uint32_t phase_start_ms;
    uint32_t phase_duration_ms;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// What walls and membranes say.
enum { FIXED_WALL = 1, MOBILE_WALL = 2 };

typedef struct {
    uint16_t sender_id;
    int32_t wall;  // FIXED_WALL or MOBILE_WALL
} __attribute__((packed)) wall_message_t;

// Parameters, the same for all robots. The simulator overrides them from the configuration file.
uint32_t run_duration_min = 200;      // ms
uint32_t run_duration_max = 1200;     // ms
uint32_t tumble_duration_min = 100;   // ms
uint32_t tumble_duration_max = 1100;  // ms

/* ---- robots ---- */

static uint32_t random_between(uint32_t low, uint32_t high) {
    return high > low ? low + (uint32_t)rand() % (high - low + 1) : low;
}

static void set_motors(uint16_t left, uint16_t right) {
    pogobot_motor_set(motorL, left);
    pogobot_motor_set(motorR, right);
}

static void enter(phase_t phase) {
    mydata->phase = phase;
    mydata->phase_start_ms = current_time_milliseconds();
    pogobot_led_setColors(0, 0, 0, 1);
    if (phase == RUN) {
        mydata->phase_duration_ms = random_between(run_duration_min, run_duration_max);
        pogobot_led_setColor(0, 255, 0);
        set_motors(motorFull, motorFull);
    } else if (phase == TUMBLE) {
        bool const to_left = rand() % 2 == 0;
        mydata->phase_duration_ms = random_between(tumble_duration_min, tumble_duration_max);
        pogobot_led_setColor(255, 0, 0);
        set_motors(to_left ? motorStop : motorFull, to_left ? motorFull : motorStop);
    } else {
        set_motors(motorStop, motorStop);
        pogobot_led_setColor(0, 0, 255);
        pogobot_led_setColors(0, 0, 255, 1);
    }
}

static void robot_receive(message_t* message) {
    if (message->header.payload_length < sizeof(wall_message_t)) {
        return;
    }
    wall_message_t heard;
    memcpy(&heard, message->payload, sizeof(heard));
    if (heard.wall == FIXED_WALL && mydata->phase != AT_WALL) {
        enter(AT_WALL);
    } else if (heard.wall == MOBILE_WALL) {
        if (mydata->phase == AT_WALL) {
            enter(TUMBLE);
        }
        pogobot_led_setColor(255, 255, 0);
        pogobot_led_setColors(255, 255, 0, 1);
    }
}

static void robot_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = 5;
    msg_rx_fn = robot_receive;
    enter(TUMBLE);
}

static void robot_step(void) {
    bool const is_over = current_time_milliseconds() - mydata->phase_start_ms >= mydata->phase_duration_ms;
    if (mydata->phase != AT_WALL && is_over) {
        enter(mydata->phase == RUN ? TUMBLE : RUN);
    }
}

/* ---- walls and membranes ---- */

static bool wall_send(void) {
    wall_message_t message = {
        .sender_id = pogobot_helper_getid(),
        .wall = current_robot_category_is("walls") ? FIXED_WALL : MOBILE_WALL,
    };
    pogobot_infrared_sendLongMessage_omniGen((uint8_t*)&message, sizeof(message));
    return true;
}

static void wall_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 10;
    max_nb_processed_msg_per_tick = 0;
    percent_msgs_sent_per_ticks = 75;
    msg_tx_fn = wall_send;
    error_codes_led_idx = -1;
    pogobot_infrared_set_power(pogobot_infrared_emitter_power_twoThird);
}

static void wall_step(void) {}

#ifdef SIMULATOR
#define MAX_DURATION_MS 10000000  // nearly three hours

// Called once, before the robots start.
static void global_setup(void) {
    init_from_configuration(run_duration_min);
    check_parameter(run_duration_min, 0, MAX_DURATION_MS);
    init_from_configuration(run_duration_max);
    check_parameter(run_duration_max, 0, MAX_DURATION_MS);
    init_from_configuration(tumble_duration_min);
    check_parameter(tumble_duration_min, 0, MAX_DURATION_MS);
    init_from_configuration(tumble_duration_max);
    check_parameter(tumble_duration_max, 0, MAX_DURATION_MS);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(robot_init, robot_step, "robots");
    pogobot_start(wall_init, wall_step, "walls");
    pogobot_start(wall_init, wall_step, "membranes");
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}
