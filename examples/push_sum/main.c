// Push-sum: all robots find the mean of a value that each knows a part of, by talking to neighbours only (D. Kempe,
// A. Dobra, J. Gehrke, "Gossip-based computation of aggregate information", FOCS 2003).
//
// Shows: a distributed computation that must not lose anything on links that lose messages, or work in one direction
// only.
//
// Each robot has a sum s, at first its id, and a weight w, at first 1. In each round it splits both into equal parts,
// one for itself and one for each of its d neighbours, which add it to their own. The sum of all s stays the same, and
// so does that of all w, while differences even out: s / w becomes the mean of all ids everywhere.
//
// That only holds if each share arrives exactly once at exactly d robots. Two precautions see to that:
// - A message states the total of all shares that its sender has ever given to each neighbour, and the receiver takes
//   what it has not had yet. So a lost message does no harm, the next one makes up for it, and a copy adds nothing
//   (the running sums of C. N. Hadjicostis, N. H. Vaidya, A. D. Dominguez-Garcia, "Robust distributed average consensus
//   via exchange of running sums", IEEE Trans. Automatic Control 61, 2016).
// - A message lists the robots that its sender hears, and which of them get shares: those that list the sender in turn,
//   since one robot may hear another that does not hear it.
// When neighbours part, each takes back what it gave since it last heard the other. That is right up to the last share
// or so: with `moving_robots: true` all find the same value, but only roughly the mean.
//
//     ./examples/push_sum/push_sum -c conf/push_sum.yaml
#include "pogobase.h"

#define MAX_NEIGHBORS 40
#define SETTLE_MS 2000  // of listening before the first share, so that all robots know their neighbours
#define TURN_MS 1000    // of a moving robot between two random turns

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
    float given_s, given_w;  // totals of all shares given to each listener
    uint8_t nb_listeners;
    uint8_t nb_heard;
    uint16_t heard[MAX_NEIGHBORS];  // `nb_heard` neighbours; the first `nb_listeners` of them get shares
} message_content_t;

typedef struct {
    uint16_t id;
    uint32_t heard_ms[IR_RX_COUNT];      // when it last was heard at each face; 0: never
    uint32_t hears_me_ms;                // when it last said so; 0: it does not
    float taken_s, taken_w;              // of its totals
    float heard_given_s, heard_given_w;  // own totals when it last said that it hears this robot
} neighbor_t;

typedef struct {
    float s, w;
    float given_s, given_w;    // as in the message
    float flying_s, flying_w;  // sent in this tick, to arrive in the next one
    int32_t round;
    uint32_t next_round_ms;
    neighbor_t neighbors[MAX_NEIGHBORS];
    uint8_t nb_neighbors;
    uint8_t dir_neighbors[IR_RX_COUNT];
    uint32_t next_turn_ms;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
uint32_t heartbeat_hz = 30;  // messages per second
uint32_t gossip_hz = 15;     // rounds per second
uint32_t max_age = 1000;     // ms without a message after which a neighbour is forgotten
bool moving_robots = false;

static bool is_recent(uint32_t event_ms) {
    return event_ms > 0 && current_time_milliseconds() - event_ms <= max_age;
}

static bool is_alive(neighbor_t const* neighbor) {
    for (uint8_t face = 0; face < IR_RX_COUNT; face++) {
        if (is_recent(neighbor->heard_ms[face])) {
            return true;
        }
    }
    return false;
}

static bool is_listener(neighbor_t const* neighbor) {
    return neighbor->hears_me_ms > 0;
}

static neighbor_t* find_neighbor(uint16_t id) {
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        if (mydata->neighbors[i].id == id) {
            return &mydata->neighbors[i];
        }
    }
    return NULL;
}

// Takes back what a neighbour that no longer listens cannot have heard.
static void part_with_listener(neighbor_t* neighbor) {
    mydata->s += mydata->given_s - neighbor->heard_given_s;
    mydata->w += mydata->given_w - neighbor->heard_given_w;
    neighbor->hears_me_ms = 0;
}

// Forgets silent neighbours and counts the others by the face that hears them.
static void review_neighbors(void) {
    memset(mydata->dir_neighbors, 0, sizeof(mydata->dir_neighbors));
    uint8_t kept = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        neighbor_t neighbor = mydata->neighbors[i];
        if (is_listener(&neighbor) && !is_recent(neighbor.hears_me_ms)) {
            part_with_listener(&neighbor);
        }
        if (!is_alive(&neighbor)) {
            continue;
        }
        mydata->neighbors[kept++] = neighbor;
        for (uint8_t face = 0; face < IR_RX_COUNT; face++) {
            mydata->dir_neighbors[face] += is_recent(neighbor.heard_ms[face]);
        }
    }
    mydata->nb_neighbors = kept;
}

// One round: a share for each neighbour that hears this robot, and one stays.
static void split(void) {
    uint8_t nb_listeners = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        nb_listeners += is_listener(&mydata->neighbors[i]);
    }
    if (nb_listeners == 0) {
        return;
    }
    float const before_s = mydata->given_s, before_w = mydata->given_w;
    mydata->given_s += mydata->s / (float)(nb_listeners + 1);
    mydata->given_w += mydata->w / (float)(nb_listeners + 1);
    // The shares as rounded in the totals: what leaves here is then exactly what arrives there.
    mydata->flying_s = (mydata->given_s - before_s) * (float)nb_listeners;
    mydata->flying_w = (mydata->given_w - before_w) * (float)nb_listeners;
    mydata->s -= mydata->flying_s;
    mydata->w -= mydata->flying_w;
    mydata->round++;
}

static uint16_t message_size(message_content_t const* message) {
    size_t const unused = MAX_NEIGHBORS - (size_t)message->nb_heard;
    return (uint16_t)(sizeof(*message) - unused * sizeof(message->heard[0]));
}

// Appends the neighbours that get shares, or the others.
static void list_neighbors(message_content_t* message, bool listeners) {
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        if (is_listener(&mydata->neighbors[i]) == listeners) {
            message->heard[message->nb_heard++] = mydata->neighbors[i].id;
        }
    }
}

static bool send_message(void) {
    uint32_t const now_ms = current_time_milliseconds();
    if (now_ms >= mydata->next_round_ms) {
        mydata->next_round_ms += 1000 / gossip_hz;
        split();
    }
    message_content_t message = {
        .sender_id = pogobot_helper_getid(), .given_s = mydata->given_s, .given_w = mydata->given_w};
    list_neighbors(&message, true);
    message.nb_listeners = message.nb_heard;
    list_neighbors(&message, false);
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&message, message_size(&message)) == 0;
}

// Where a message lists this robot, or nb_heard.
static uint8_t place_of_me(message_content_t const* message) {
    uint8_t place = 0;
    while (place < message->nb_heard && message->heard[place] != pogobot_helper_getid()) {
        place++;
    }
    return place;
}

static void process_message(message_t* received) {
    message_content_t message = {0};
    uint16_t const length = received->header.payload_length;
    memcpy(&message, received->payload, length < sizeof(message) ? length : sizeof(message));
    if (message.nb_heard > MAX_NEIGHBORS || length != message_size(&message)) {
        return;
    }
    neighbor_t* neighbor = find_neighbor(message.sender_id);
    if (neighbor == NULL) {
        if (mydata->nb_neighbors == MAX_NEIGHBORS) {
            return;
        }
        // What the newcomer gave before was for others.
        neighbor = &mydata->neighbors[mydata->nb_neighbors++];
        *neighbor = (neighbor_t){.id = message.sender_id, .taken_s = message.given_s, .taken_w = message.given_w};
    }
    neighbor->heard_ms[received->header._receiver_ir_index] = current_time_milliseconds();
    uint8_t const place = place_of_me(&message);
    if (place < message.nb_heard) {
        neighbor->hears_me_ms = current_time_milliseconds();
        neighbor->heard_given_s = mydata->given_s;
        neighbor->heard_given_w = mydata->given_w;
    }
    if (place < message.nb_listeners) {
        mydata->s += message.given_s - neighbor->taken_s;
        mydata->w += message.given_w - neighbor->taken_w;
    }
    neighbor->taken_s = message.given_s;
    neighbor->taken_w = message.given_w;
}

static float estimated_mean(void) {
    return mydata->w > 0.0f ? mydata->s / mydata->w : 0.0f;
}

static void show_state(void) {
    uint8_t r, g, b;
    qualitative_colormap((uint8_t)((uint32_t)estimated_mean() % 10), &r, &g, &b);
    pogobot_led_setColor(r, g, b);
    for (uint8_t face = 0; face < IR_RX_COUNT; face++) {
        qualitative_colormap(mydata->dir_neighbors[face], &r, &g, &b);
        pogobot_led_setColors(r, g, b, face + 1);  // LED 1 is the front's, and so on
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

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = NUMEL;  // all that the queue holds
    // The main loop draws when to send; it makes 62.5 ticks per second.
    percent_msgs_sent_per_ticks = (uint8_t)(heartbeat_hz < 62 ? heartbeat_hz * 8 / 5 : 100);
    msg_rx_fn = process_message;
    msg_tx_fn = send_message;
    error_codes_led_idx = -1;  // all LEDs are ours
    mydata->s = (float)pogobot_helper_getid();
    mydata->w = 1.0f;
    mydata->next_round_ms = SETTLE_MS;
}

void user_step(void) {
    mydata->flying_s = 0.0f;
    mydata->flying_w = 0.0f;
    review_neighbors();
    show_state();
    if (moving_robots) {
        walk_at_random();
    }
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(heartbeat_hz);
    check_parameter(heartbeat_hz, 1, 1000);
    init_from_configuration(gossip_hz);
    check_parameter(gossip_hz, 1, 1000);
    init_from_configuration(max_age);
    init_from_configuration(moving_robots);
}

static char const* const dir_columns[IR_RX_COUNT] = {"dir0_neighbors", "dir1_neighbors", "dir2_neighbors",
                                                     "dir3_neighbors"};

static void create_data_schema(void) {
    data_add_column_double("s_value");
    data_add_column_double("w_value");
    data_add_column_double("estimate");
    data_add_column_int32("round");
    for (uint8_t face = 0; face < IR_RX_COUNT; face++) {
        data_add_column_int8(dir_columns[face]);
    }
    data_add_column_int8("total_neighbors");
    data_add_column_string("neighbors_list");
}

static void export_data(void) {
    // A share that is on its way still counts for its sender.
    data_set_value_double("s_value", mydata->s + mydata->flying_s);
    data_set_value_double("w_value", mydata->w + mydata->flying_w);
    data_set_value_double("estimate", estimated_mean());
    data_set_value_int32("round", mydata->round);
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
