// Naming game: robots invent words for a thing and end up with a common one (L. Steels, "A self-organizing spatial
// vocabulary", Artificial Life 2, 1995; A. Baronchelli et al., "Sharp transition towards shared vocabularies in
// multi-agent systems", J. Stat. Mech. P06014, 2006).
//
// Shows: sets as bit fields, telling copies of a message apart, columns of its own in the data file.
//
// Each robot knows a set of words out of 256, empty at the start. Now and then it speaks: it draws one of its words, or
// invents one if it has none, and tells it to all neighbours. A listener that does not know the word learns it. One
// that does forgets all others. The speaker does not learn whether it was understood: this is the listener-only game,
// made for broadcasting (A. Baronchelli, "Role of feedback and broadcasting in the naming game", Phys. Rev. E 83,
// 046103, 2011). At first vocabularies grow, then groups agree, grow, and one word remains.
//
// The head shows the word of a robot that knows one only, and white when it hesitates; the ring shines green where all
// neighbours last said that same word.
//
//     ./examples/naming_game/naming_game -c conf/naming_game.yaml
#include "pogobase.h"

#define NB_WORDS 256
#define MAX_NEIGHBORS 20
#define TURN_MS 1000  // between two random turns

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
    uint8_t number;  // of the utterance: two faces may hear the same one
    uint8_t word;
} speech_t;

typedef struct {
    speech_t speech;  // the last one
    uint32_t heard_ms;
} neighbor_t;

typedef struct {
    uint8_t knows[NB_WORDS / 8];  // a bit per word
    uint16_t nb_words;
    uint8_t number;  // of own speeches
    uint8_t word;    // the only one known, or else the last one said
    neighbor_t neighbors[MAX_NEIGHBORS];
    uint8_t nb_neighbors;
    uint32_t next_turn_ms;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
uint8_t speak_percent = 20;  // chance (%) to speak in a tick
uint32_t max_age = 1000;     // ms without a speech after which a neighbour is forgotten
bool moving_robots = true;

// ---- Vocabulary ----

static bool knows(uint8_t word) {
    return mydata->knows[word / 8] >> (word % 8) & 1;
}

static void learn(uint8_t word) {
    if (!knows(word)) {
        mydata->knows[word / 8] |= (uint8_t)(1 << (word % 8));
        mydata->nb_words++;
    }
    if (mydata->nb_words == 1) {
        mydata->word = word;
    }
}

static void forget_all_but(uint8_t word) {
    memset(mydata->knows, 0, sizeof(mydata->knows));
    mydata->nb_words = 0;
    learn(word);
}

static uint8_t draw_word(void) {
    int left = rand() % mydata->nb_words;
    uint8_t word = 0;
    while (!knows(word) || left-- > 0) {
        word++;
    }
    return word;
}

// ---- Game ----

static bool speak(void) {
    if (mydata->nb_words == 0) {
        learn((uint8_t)(rand() % NB_WORDS));
    }
    mydata->word = draw_word();
    speech_t speech = {.sender_id = pogobot_helper_getid(), .number = ++mydata->number, .word = mydata->word};
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&speech, sizeof(speech)) == 0;
}

static void listen(message_t* message) {
    speech_t speech;
    if (message->header.payload_length < sizeof(speech)) {
        return;
    }
    memcpy(&speech, message->payload, sizeof(speech));
    uint8_t place = 0;
    while (place < mydata->nb_neighbors && mydata->neighbors[place].speech.sender_id != speech.sender_id) {
        place++;
    }
    if (place == MAX_NEIGHBORS) {
        return;
    }
    bool const is_new = place == mydata->nb_neighbors;
    bool const is_copy = !is_new && mydata->neighbors[place].speech.number == speech.number;
    mydata->nb_neighbors += is_new;
    mydata->neighbors[place] = (neighbor_t){.speech = speech, .heard_ms = current_time_milliseconds()};
    if (is_copy) {
        return;
    }
    if (knows(speech.word)) {
        forget_all_but(speech.word);
    } else {
        learn(speech.word);
    }
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

// Neighbours that last said the word of this robot.
static uint8_t nb_agreeing_neighbors(void) {
    uint8_t agreeing = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        agreeing += mydata->neighbors[i].speech.word == mydata->word;
    }
    return agreeing;
}

static void show_state(void) {
    uint8_t r = 5, g = 5, b = 5;
    if (mydata->nb_words == 1) {
        rainbow_colormap(mydata->word, &r, &g, &b);
    }
    pogobot_led_setColor(r, g, b);
    bool const consensus = mydata->nb_neighbors > 0 && nb_agreeing_neighbors() == mydata->nb_neighbors;
    for (uint8_t led = 1; led <= 4; led++) {
        pogobot_led_setColors(0, consensus ? 25 : 0, 0, led);
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
    percent_msgs_sent_per_ticks = speak_percent;
    msg_rx_fn = listen;
    msg_tx_fn = speak;
    error_codes_led_idx = -1;  // the ring is ours
}

void user_step(void) {
    forget_silent_neighbors();
    show_state();
    if (moving_robots) {
        walk_at_random();
    }
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(speak_percent);
    check_parameter(speak_percent, 0, 100);
    init_from_configuration(max_age);
    init_from_configuration(moving_robots);
}

static void create_data_schema(void) {
    data_add_column_int16("nb_words");
    data_add_column_int16("word");
    data_add_column_int8("nb_neighbors");
    data_add_column_int8("nb_agreeing_neighbors");
}

static void export_data(void) {
    data_set_value_int16("nb_words", mydata->nb_words);
    if (mydata->nb_words > 0) {  // otherwise there is none yet: null
        data_set_value_int16("word", mydata->word);
    }
    data_set_value_int8("nb_neighbors", mydata->nb_neighbors);
    data_set_value_int8("nb_agreeing_neighbors", nb_agreeing_neighbors());
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
