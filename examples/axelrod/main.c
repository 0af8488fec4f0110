// Axelrod's culture: robots that become more similar to those that are already similar, and yet stay different
// (R. Axelrod, "The dissemination of culture: a model with local convergence and global polarization", Journal of
// Conflict Resolution 41, 1997; C. Castellano, M. Marsili, A. Vespignani, "Nonequilibrium phase transition in a model
// for social influence", Physical Review Letters 85, 2000).
//
// Shows: a message whose length depends on a parameter, a table of neighbours, columns named by the program.
//
// The culture of a robot is a list of features (its language, its religion, its music ...), each with one of nb_traits
// traits, drawn at the start. Now and then a robot looks at a neighbour drawn at random. With a probability equal to
// the share of the features in which the two agree it adopts one of the neighbour's other traits. So neighbours that
// have anything in common tend to become equal, and those that have nothing in common never talk again. In the end
// each pair of neighbours is equal or has nothing in common, and nothing can change any more: few traits (or many
// features) lead to one culture, many traits to many. No trait is ever invented, so the number of different traits
// of a feature never rises.
//
// The head shows the first three traits as red, green and blue. The ring is green where all neighbours are equal, red
// where the others have nothing in common with the robot (the border of two cultures), and dark where talks go on.
//
//     ./examples/axelrod/axelrod -c conf/axelrod.yaml
//
// The robots stand on a grid as in the article; with `moving_robots: true` they walk around, and only cultures that
// have nothing in common with any other remain.
#include "pogobase.h"

#define MAX_FEATURES 8
#define MAX_TRAITS 100
#define MAX_NEIGHBORS 20
#define TURN_MS 1000  // between two random turns
#define BRIGHTEST 25  // of the LEDs

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
    uint8_t traits[MAX_FEATURES];  // only nb_features of them are sent
} message_content_t;

typedef struct {
    uint16_t id;
    uint8_t traits[MAX_FEATURES];
    uint32_t heard_ms;
} neighbor_t;

typedef struct {
    uint8_t traits[MAX_FEATURES];
    neighbor_t neighbors[MAX_NEIGHBORS];
    uint8_t nb_neighbors;
    uint32_t next_talk_ms;
    uint32_t next_turn_ms;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
uint8_t nb_features = 3;
uint8_t nb_traits = 8;       // that each feature can have
uint32_t talk_period = 200;  // ms between two talks of a robot, on average
uint32_t max_age = 1000;     // ms without a message after which a neighbour is forgotten
bool moving_robots = false;

// ---- Culture ----

// Number of features in which the robot and a neighbour agree.
static uint8_t overlap(uint8_t const traits[]) {
    uint8_t same = 0;
    for (uint8_t i = 0; i < nb_features; i++) {
        same += traits[i] == mydata->traits[i];
    }
    return same;
}

// Adopts one trait, drawn at random, of those in which a neighbour differs.
static void adopt_a_trait(uint8_t const traits[]) {
    int left = rand() % (nb_features - overlap(traits));
    for (uint8_t i = 0; i < nb_features; i++) {
        if (traits[i] != mydata->traits[i] && left-- == 0) {
            mydata->traits[i] = traits[i];
            return;
        }
    }
}

static void talk_to_a_neighbor(void) {
    if (mydata->nb_neighbors == 0) {
        return;
    }
    uint8_t const* traits = mydata->neighbors[rand() % mydata->nb_neighbors].traits;
    uint8_t const same = overlap(traits);
    if (same < nb_features && rand() % nb_features < same) {
        adopt_a_trait(traits);
    }
}

static uint8_t nb_equal_neighbors(void) {
    uint8_t equal = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        equal += overlap(mydata->neighbors[i].traits) == nb_features;
    }
    return equal;
}

// Whether no talk can change the robot: each neighbour is equal or has nothing in common with it.
static bool is_settled(void) {
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        uint8_t const same = overlap(mydata->neighbors[i].traits);
        if (same > 0 && same < nb_features) {
            return false;
        }
    }
    return true;
}

static uint8_t brightness(uint8_t feature) {
    bool const is_shown = feature < nb_features && nb_traits > 1;
    return (uint8_t)(is_shown ? mydata->traits[feature] * BRIGHTEST / (nb_traits - 1) : 0);
}

static void show_culture(void) {
    pogobot_led_setColor(brightness(0), brightness(1), brightness(2));
    bool const is_among_equals = nb_equal_neighbors() == mydata->nb_neighbors;
    bool const is_at_border = !is_among_equals && is_settled();
    for (uint8_t led = 1; led <= 4; led++) {
        pogobot_led_setColors(is_at_border ? BRIGHTEST : 0, is_among_equals ? BRIGHTEST : 0, 0, led);
    }
}

// ---- Messages ----

static bool send_culture(void) {
    message_content_t message = {.sender_id = pogobot_helper_getid()};
    memcpy(message.traits, mydata->traits, nb_features);
    uint16_t const size = (uint16_t)(sizeof(message.sender_id) + nb_features);
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&message, size) == 0;
}

static void process_message(message_t* received) {
    message_content_t message = {0};
    uint16_t const size = (uint16_t)(sizeof(message.sender_id) + nb_features);
    if (received->header.payload_length < size) {
        return;
    }
    memcpy(&message, received->payload, size);
    uint8_t place = 0;
    while (place < mydata->nb_neighbors && mydata->neighbors[place].id != message.sender_id) {
        place++;
    }
    if (place == MAX_NEIGHBORS) {
        return;
    }
    mydata->nb_neighbors += place == mydata->nb_neighbors;
    neighbor_t* neighbor = &mydata->neighbors[place];
    neighbor->id = message.sender_id;
    neighbor->heard_ms = current_time_milliseconds();
    memcpy(neighbor->traits, message.traits, nb_features);
}

static void forget_silent_neighbors(void) {
    uint8_t kept = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        if (current_time_milliseconds() - mydata->neighbors[i].heard_ms <= max_age) {
            mydata->neighbors[kept++] = mydata->neighbors[i];
        }
    }
    mydata->nb_neighbors = kept;
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
    percent_msgs_sent_per_ticks = 20;
    msg_rx_fn = process_message;
    msg_tx_fn = send_culture;
    error_codes_led_idx = -1;  // the ring is ours
    for (uint8_t i = 0; i < nb_features; i++) {
        mydata->traits[i] = (uint8_t)(rand() % nb_traits);
    }
}

void user_step(void) {
    forget_silent_neighbors();
    if (current_time_milliseconds() >= mydata->next_talk_ms) {
        // Not all at once, and in no fixed order.
        mydata->next_talk_ms = current_time_milliseconds() + talk_period / 2 + (uint32_t)rand() % (talk_period + 1);
        talk_to_a_neighbor();
    }
    show_culture();
    if (moving_robots) {
        walk_at_random();
    }
}

#ifdef SIMULATOR
#define MAX_DURATION_MS 10000000  // nearly three hours

static char const* const trait_columns[MAX_FEATURES] = {"trait_0", "trait_1", "trait_2", "trait_3",
                                                        "trait_4", "trait_5", "trait_6", "trait_7"};

static void global_setup(void) {
    init_from_configuration(nb_features);
    check_parameter(nb_features, 1, MAX_FEATURES);
    init_from_configuration(nb_traits);
    check_parameter(nb_traits, 1, MAX_TRAITS);
    init_from_configuration(talk_period);
    check_parameter(talk_period, 1, MAX_DURATION_MS);
    init_from_configuration(max_age);
    init_from_configuration(moving_robots);
}

static void create_data_schema(void) {
    for (uint8_t i = 0; i < nb_features; i++) {
        data_add_column_int8(trait_columns[i]);
    }
    data_add_column_int8("nb_neighbors");
    data_add_column_int8("nb_equal_neighbors");
    data_add_column_bool("is_settled");
}

static void export_data(void) {
    for (uint8_t i = 0; i < nb_features; i++) {
        data_set_value_int8(trait_columns[i], (int8_t)mydata->traits[i]);
    }
    data_set_value_int8("nb_neighbors", (int8_t)mydata->nb_neighbors);
    data_set_value_int8("nb_equal_neighbors", (int8_t)nb_equal_neighbors());
    data_set_value_bool("is_settled", is_settled());
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
