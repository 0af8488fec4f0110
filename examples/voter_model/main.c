// Voter model: opinions spread by imitation until all agree (P. Clifford, A. Sudbury, "A model for spatial conflict",
// Biometrika 60, 1973; R. A. Holley, T. M. Liggett, Annals of Probability 3, 1975).
//
// Shows: an algorithm with two lines (copy_a_neighbor), random choice among neighbours, sending by chance, a random
// walk.
//
// Each robot has one of four opinions, drawn at the start. At each tick it adopts the opinion of a neighbour drawn
// at random. No opinion is better than another, yet one of them wins: which one is random, with the share of the
// robots that had it at the start as its probability. The head shows the opinion; the ring shines green where all
// neighbours have the same one.
//
//     ./examples/voter_model/voter_model -c conf/voter_model.yaml
//
// The robots walk around, so that all of them meet. With `moving_robots: false` groups out of each other's reach may
// settle on different opinions.
#include "pogobase.h"

#define NB_OPINIONS 4
#define MAX_NEIGHBORS 20
#define TURN_MS 1000  // between two random turns

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
    uint8_t opinion;
} message_content_t;

typedef struct {
    uint16_t id;
    uint8_t opinion;
    uint32_t heard_ms;
} neighbor_t;

typedef struct {
    uint8_t opinion;
    neighbor_t neighbors[MAX_NEIGHBORS];
    uint8_t nb_neighbors;
    uint32_t next_turn_ms;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
uint32_t max_age = 300;  // ms without a message after which a neighbour is forgotten
bool moving_robots = true;

static void forget_silent_neighbors(void) {
    uint8_t kept = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        if (current_time_milliseconds() - mydata->neighbors[i].heard_ms <= max_age) {
            mydata->neighbors[kept++] = mydata->neighbors[i];
        }
    }
    mydata->nb_neighbors = kept;
}

static void copy_a_neighbor(void) {
    if (mydata->nb_neighbors > 0) {
        mydata->opinion = mydata->neighbors[rand() % mydata->nb_neighbors].opinion;
    }
}

static bool neighbors_agree(void) {
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        if (mydata->neighbors[i].opinion != mydata->opinion) {
            return false;
        }
    }
    return mydata->nb_neighbors > 0;
}

static void show_state(void) {
    uint8_t r, g, b;
    rainbow_colormap((uint8_t)(mydata->opinion * 256 / NB_OPINIONS), &r, &g, &b);
    pogobot_led_setColor(r, g, b);
    for (uint8_t led = 1; led <= 4; led++) {
        pogobot_led_setColors(0, neighbors_agree() ? 25 : 0, 0, led);
    }
}

// Now and then ahead, to the left or to the right.
static void walk_at_random(void) {
    if (current_time_milliseconds() >= mydata->next_turn_ms) {
        mydata->next_turn_ms += TURN_MS;
        int const way = rand() % 3;
        pogobot_motor_set(motorL, way == 1 ? motorStop : motorFull);
        pogobot_motor_set(motorR, way == 2 ? motorStop : motorFull);
    }
}

static bool send_opinion(void) {
    message_content_t message = {.sender_id = pogobot_helper_getid(), .opinion = mydata->opinion};
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&message, sizeof(message)) == 0;
}

static void process_message(message_t* received) {
    message_content_t message;
    if (received->header.payload_length < sizeof(message)) {
        return;
    }
    memcpy(&message, received->payload, sizeof(message));
    uint8_t place = 0;
    while (place < mydata->nb_neighbors && mydata->neighbors[place].id != message.sender_id) {
        place++;
    }
    if (place == MAX_NEIGHBORS) {
        return;
    }
    if (place == mydata->nb_neighbors) {
        mydata->nb_neighbors++;
    }
    mydata->neighbors[place] =
        (neighbor_t){.id = message.sender_id, .opinion = message.opinion, .heard_ms = current_time_milliseconds()};
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = NUMEL;  // all that the queue holds
    percent_msgs_sent_per_ticks = 50;
    msg_rx_fn = process_message;
    msg_tx_fn = send_opinion;
    error_codes_led_idx = -1;  // the ring is ours
    mydata->opinion = (uint8_t)(rand() % NB_OPINIONS);
}

void user_step(void) {
    forget_silent_neighbors();
    copy_a_neighbor();
    show_state();
    if (moving_robots) {
        walk_at_random();
    }
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(max_age);
    init_from_configuration(moving_robots);
}

static void create_data_schema(void) {
    data_add_column_int8("opinion");
    data_add_column_int8("nb_neighbors");
    data_add_column_bool("local_consensus");
}

static void export_data(void) {
    data_set_value_int8("opinion", mydata->opinion);
    data_set_value_int8("nb_neighbors", mydata->nb_neighbors);
    data_set_value_bool("local_consensus", neighbors_agree());
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
