// The voter model on a complete graph (Clifford and Sudbury, 1973; Holley and Liggett, 1975): robots have one of two
// opinions, half of them each. At each tick, each robot adopts, with the probability update_percent, the opinion of
// another robot drawn at random from all. Robots announce their opinion at the start and whenever it changes. All hear
// it and write it down; so each knows when all agree.
#include "pogobase.h"

#define MAX_ROBOTS 256

typedef struct __attribute__((__packed__)) {
    uint8_t id;
    uint8_t opinion;
} content_t;

typedef struct {
    uint8_t opinion;               // 0 or 1
    uint8_t opinions[MAX_ROBOTS];  // of all robots, as announced
    int32_t consensus_tick;        // when all agreed; -1: not yet
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
uint16_t nb_robots = 32;     // as in the configuration, at most 256
uint8_t update_percent = 5;  // chance to adopt an opinion in a tick

static void announce(void) {
    content_t content = {.id = (uint8_t)pogobot_helper_getid(), .opinion = mydata->opinion};
    mydata->opinions[content.id] = content.opinion;
    pogobot_infrared_sendShortMessage_omni((uint8_t*)&content, sizeof(content));
}

static void listen(void) {
    pogobot_infrared_update();
    while (pogobot_infrared_message_available()) {
        message_t message;
        pogobot_infrared_recover_next_message(&message);
        mydata->opinions[message.payload[0]] = message.payload[1];
    }
}

static bool all_agree(void) {
    for (uint16_t i = 1; i < nb_robots; i++) {
        if (mydata->opinions[i] != mydata->opinions[0]) {
            return false;
        }
    }
    return true;
}

// The state of a random other robot.
static uint8_t opinion_of_another(void) {
    uint16_t const other = (uint16_t)(pogobot_helper_getid() + 1 + rand() % (nb_robots - 1));
    return mydata->opinions[other % nb_robots];
}

void user_init(void) {
    // A seed has 16 bits: with two of them, no two robots of many runs draw the same numbers.
    srand((uint32_t)pogobot_helper_getRandSeed() << 16 ^ (uint16_t)pogobot_helper_getRandSeed());
    main_loop_hz = 50;
    mydata->opinion = pogobot_helper_getid() % 2;
    mydata->consensus_tick = -1;
}

void user_step(void) {
    listen();
    if (pogobot_ticks == 0) {
        announce();
    } else if (mydata->consensus_tick < 0 && all_agree()) {
        mydata->consensus_tick =
            (int32_t)pogobot_ticks - 1;  // announced in the tick before, as the first opinions were
    } else if (rand() % 100 < update_percent) {
        uint8_t const adopted = opinion_of_another();
        if (adopted != mydata->opinion) {
            mydata->opinion = adopted;
            announce();
        }
    }
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(nb_robots);
    check_parameter(nb_robots, 2, MAX_ROBOTS);
    init_from_configuration(update_percent);
    check_parameter(update_percent, 1, 100);
}

static void create_data_schema(void) {
    data_add_column_int32("consensus_tick");
    data_add_column_int8("opinion");
}

static void export_data(void) {
    static POGO_SHARED int32_t rows_since_consensus;
    data_set_value_int32("consensus_tick", mydata->consensus_tick);
    data_set_value_int8("opinion", mydata->opinion);
    rows_since_consensus += mydata->consensus_tick >= 0;
    if (rows_since_consensus > nb_robots) {
        stop_simulation();
    }
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
