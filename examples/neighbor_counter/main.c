// Neighbour counter: which robots are around me, and on which side?
//
// Shows: heartbeats, a table of neighbours that forgets those it no longer hears, the faces at which messages arrive,
// all five LEDs. It is the first layer of most swarm algorithms.
//
// Each robot sends its id several times a second, and keeps for each id it hears when it last arrived at each of the
// four faces. A neighbour counts as long as that is recent. One that stands between two faces is heard by both of them,
// so the four counts can add up to more than there are neighbours.
//
//     ./examples/neighbor_counter/neighbor_counter -c conf/neighbor_counter.yaml
#include "pogobase.h"

#define MAX_NEIGHBORS 40

typedef struct {
    uint16_t sender_id;
} heartbeat_t;

typedef struct {
    uint16_t id;
    uint32_t heard_ms[IR_RX_COUNT];  // when it was last heard at each face; 0: never
} neighbor_t;

typedef struct {
    neighbor_t neighbors[MAX_NEIGHBORS];
    uint8_t nb_neighbors;
    uint8_t dir_neighbors[IR_RX_COUNT];  // neighbours heard at each face
    uint32_t next_heartbeat_ms;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
uint32_t heartbeat_hz = 10;
uint32_t max_age = 1000;  // ms without a heartbeat after which a neighbour is forgotten

static bool is_recent(uint32_t heard_ms) {
    return heard_ms > 0 && current_time_milliseconds() - heard_ms <= max_age;
}

static bool is_alive(neighbor_t const* neighbor) {
    for (uint8_t face = 0; face < IR_RX_COUNT; face++) {
        if (is_recent(neighbor->heard_ms[face])) {
            return true;
        }
    }
    return false;
}

// The entry of an id, a new one if there is none; NULL when the table is full.
static neighbor_t* neighbor_with_id(uint16_t id) {
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        if (mydata->neighbors[i].id == id) {
            return &mydata->neighbors[i];
        }
    }
    if (mydata->nb_neighbors == MAX_NEIGHBORS) {
        return NULL;
    }
    neighbor_t* const neighbor = &mydata->neighbors[mydata->nb_neighbors++];
    *neighbor = (neighbor_t){.id = id};
    return neighbor;
}

static void forget_silent_neighbors(void) {
    uint8_t kept = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        if (is_alive(&mydata->neighbors[i])) {
            mydata->neighbors[kept++] = mydata->neighbors[i];
        }
    }
    mydata->nb_neighbors = kept;
}

static void count_by_face(void) {
    for (uint8_t face = 0; face < IR_RX_COUNT; face++) {
        mydata->dir_neighbors[face] = 0;
        for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
            mydata->dir_neighbors[face] += is_recent(mydata->neighbors[i].heard_ms[face]);
        }
    }
}

static void show_counts(void) {
    uint8_t r, g, b;
    qualitative_colormap(mydata->nb_neighbors, &r, &g, &b);
    pogobot_led_setColor(r, g, b);
    for (uint8_t face = 0; face < IR_RX_COUNT; face++) {
        qualitative_colormap(mydata->dir_neighbors[face], &r, &g, &b);
        pogobot_led_setColors(r, g, b, face + 1);  // LED 1 is the front's, and so on
    }
}

static bool send_heartbeat(void) {
    if (current_time_milliseconds() < mydata->next_heartbeat_ms) {
        return false;
    }
    mydata->next_heartbeat_ms += 1000 / heartbeat_hz;
    heartbeat_t heartbeat = {.sender_id = pogobot_helper_getid()};
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&heartbeat, sizeof(heartbeat)) == 0;
}

static void process_message(message_t* message) {
    heartbeat_t heartbeat;
    if (message->header.payload_length < sizeof(heartbeat) || message->header._receiver_ir_index >= IR_RX_COUNT) {
        return;
    }
    memcpy(&heartbeat, message->payload, sizeof(heartbeat));
    neighbor_t* const neighbor = neighbor_with_id(heartbeat.sender_id);
    if (neighbor != NULL) {
        neighbor->heard_ms[message->header._receiver_ir_index] = current_time_milliseconds();
    }
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = NUMEL;  // all that the queue holds
    percent_msgs_sent_per_ticks = 50;       // spreads heartbeats that are due at the same time
    msg_rx_fn = process_message;
    msg_tx_fn = send_heartbeat;
    error_codes_led_idx = -1;  // all LEDs are ours
}

void user_step(void) {
    forget_silent_neighbors();
    count_by_face();
    show_counts();
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(heartbeat_hz);
    check_parameter(heartbeat_hz, 1, 1000);
    init_from_configuration(max_age);
}

static char const* const dir_columns[IR_RX_COUNT] = {"dir0_neighbors", "dir1_neighbors", "dir2_neighbors",
                                                     "dir3_neighbors"};

static void create_data_schema(void) {
    for (uint8_t face = 0; face < IR_RX_COUNT; face++) {
        data_add_column_int8(dir_columns[face]);
    }
    data_add_column_int8("total_neighbors");
    data_add_column_string("neighbors_list");
}

static void export_data(void) {
    for (uint8_t face = 0; face < IR_RX_COUNT; face++) {
        data_set_value_int8(dir_columns[face], mydata->dir_neighbors[face]);
    }
    data_set_value_int8("total_neighbors", mydata->nb_neighbors);
    char list[MAX_NEIGHBORS * sizeof("65535,")] = "";
    int length = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        length += snprintf(list + length, sizeof(list) - (size_t)length, i > 0 ? ",%u" : "%u",
                           (unsigned)mydata->neighbors[i].id);
    }
    data_set_value_string("neighbors_list", list);
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
