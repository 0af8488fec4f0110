// Hanabi (fireworks): colours that spread through a swarm by gossip.
//
// Shows: sending and receiving messages, starting an experiment with a flash of light, columns of its own in the data
// file.
//
// After the flash and five seconds of white, each robot now and then picks a new colour on its own and becomes one
// older. Robots keep telling each other age and colour, and a robot adopts the colour of an older one. So each new
// colour runs through the swarm like a firework.
//
//     ./examples/hanabi/hanabi -c conf/demo.yaml
//
// The robots stand still; on a real robot uncomment MOVING_ROBOTS to let them circle, in the simulator set
// `parameters: {moving_robots: true}`.
#include "pogobase.h"

// #define MOVING_ROBOTS

#define FLASH_RISE 40             // rise of a photosensor within one tick that starts the experiment
#define BOOT_MS 5000              // white before the first colour
#define COLOR_COUNT 10            // colours of qualitative_colormap
#define CHANGE_CHANCE 20000       // a robot changes its colour in 2 of this many ticks
#define MAX_AGE_DIFFERENCE 10000  // a larger one is the overflow of an age

typedef struct {
    uint16_t sender_id;
    uint16_t msg_id;
    uint16_t age;
    uint8_t rgb_colors_index;
} message_content_t;

typedef enum { WAITING, BOOTING, PLAYING } phase_t;

typedef struct {
    phase_t phase;
    uint32_t boot_start_ms;
    int16_t light[3];  // photosensors at the last tick
    uint16_t age;      // how often this robot's colour has changed
    uint8_t rgb_colors_index;
    uint16_t nb_sent;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

#ifdef MOVING_ROBOTS
bool moving_robots = true;
#else
bool moving_robots = false;
#endif

static void show_color(void) {
    uint8_t r, g, b;
    qualitative_colormap(mydata->rgb_colors_index, &r, &g, &b);
    pogobot_led_setColor(r, g, b);
}

static void circle(void) {
    bool const to_left = pogobot_helper_getid() % 2 == 0;
    pogobot_motor_set(motorL, to_left ? motorHalf : motorFull);
    pogobot_motor_set(motorR, to_left ? motorFull : motorHalf);
}

// True when the light has risen on any sensor since the last call.
static bool flash_seen(void) {
    bool seen = false;
    for (uint8_t sensor = 0; sensor < 3; sensor++) {
        int16_t const light = pogobot_photosensors_read(sensor);
        seen = seen || light - mydata->light[sensor] >= FLASH_RISE;
        mydata->light[sensor] = light;
    }
    return seen;
}

static bool send_message(void) {
    if (mydata->phase != PLAYING) {
        return false;
    }
    message_content_t message = {.sender_id = pogobot_helper_getid(),
                                 .msg_id = mydata->nb_sent++,
                                 .age = mydata->age,
                                 .rgb_colors_index = mydata->rgb_colors_index};
    pogobot_infrared_sendLongMessage_omniGen((uint8_t*)&message, sizeof(message));
    return true;
}

static void process_message(message_t* received) {
    if (mydata->phase != PLAYING || received->header._packet_type != ir_t_user ||
        received->header.payload_length < sizeof(message_content_t)) {
        return;
    }
    message_content_t message;
    memcpy(&message, received->payload, sizeof(message));
    bool const older = message.age > mydata->age && message.age - mydata->age < MAX_AGE_DIFFERENCE;
    if (older && message.rgb_colors_index != mydata->rgb_colors_index) {
        mydata->age = message.age;
        mydata->rgb_colors_index = message.rgb_colors_index;
        show_color();
    }
}

static void change_color_by_chance(void) {
    if (rand() % CHANGE_CHANCE >= 2) {
        return;
    }
    uint8_t const index = (uint8_t)(rand() % COLOR_COUNT);
    if (index != mydata->rgb_colors_index) {
        mydata->rgb_colors_index = index;
        mydata->age++;
        show_color();
    }
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = 3;
    percent_msgs_sent_per_ticks = 50;
    msg_rx_fn = process_message;
    msg_tx_fn = send_message;
    pogobot_led_setColor(25, 0, 0);
    flash_seen();  // takes the first readings
}

void user_step(void) {
    switch (mydata->phase) {
        case WAITING:
            if (flash_seen()) {
                mydata->phase = BOOTING;
                mydata->boot_start_ms = current_time_milliseconds();
                pogobot_led_setColor(25, 25, 25);
            }
            break;
        case BOOTING:
            if (current_time_milliseconds() - mydata->boot_start_ms >= BOOT_MS) {
                mydata->phase = PLAYING;
                show_color();
                if (moving_robots) {
                    circle();
                }
            }
            break;
        case PLAYING:
            change_color_by_chance();
            break;
    }
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(moving_robots);
}

static void create_data_schema(void) {
    data_add_column_int32("age");
    data_add_column_int16("rgb_colors_index");
}

static void export_data(void) {
    if (mydata->phase == WAITING) {
        disable_data_export();
        return;
    }
    enable_data_export();
    data_set_value_int32("age", mydata->age);
    data_set_value_int16("rgb_colors_index", mydata->rgb_colors_index);
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
