// Questions and answers: robots that wait for a reply.
//
// Shows: a program for the robots' SDK that waits in the middle of what it does: for an answer, with a limit in time,
// and for a moment to pass. While one robot waits, the others go on.
//
// A robot with an even id asks "who is there?", and waits up to half a second for an answer; then it takes a break of a
// random time. One with an odd id answers each question after a moment, as long as it takes to make up its mind. The
// LED is blue while a robot waits, green after an answer, and red if there was none.
//
//     ./examples/question/question -c conf/question.yaml
#include "pogobot.h"

#ifdef SIMULATOR
#include "pogosim/simulation.h"
#endif

#define ANSWER_LIMIT_US 500000
#define THINKING_MS 80

typedef enum { QUESTION, ANSWER } kind_t;

typedef struct __attribute__((__packed__)) {
    uint8_t kind;
    uint16_t from;
    uint16_t to;  // of an answer
} talk_t;

// Variables of this robot.
static uint32_t asked;
static uint32_t answered;  // questions that got an answer
static int32_t waited_ms;  // for the last answer

static void say(kind_t kind, uint16_t to) {
    talk_t talk = {.kind = (uint8_t)kind, .from = pogobot_helper_getid(), .to = to};
    pogobot_infrared_sendShortMessage_omni((uint8_t*)&talk, sizeof(talk));
}

/// Takes the next message out of the queue; false: there is none, or it is of another program.
static bool hear(talk_t* talk) {
    pogobot_infrared_update();
    if (!pogobot_infrared_message_available()) {
        return false;
    }
    message_t message;
    pogobot_infrared_recover_next_message(&message);
    if (message.header.payload_length != sizeof(talk_t)) {
        return false;
    }
    memcpy(talk, message.payload, sizeof(*talk));
    return true;
}

/// Waits for an answer. False: none came within the limit.
static bool wait_for_answer(void) {
    time_reference_t waiting;
    talk_t talk;
    pogobot_stopwatch_reset(&waiting);
    do {
        if (hear(&talk) && talk.kind == ANSWER && talk.to == pogobot_helper_getid()) {
            waited_ms = pogobot_stopwatch_get_elapsed_microseconds(&waiting) / 1000;
            return true;
        }
    } while (pogobot_stopwatch_get_elapsed_microseconds(&waiting) < ANSWER_LIMIT_US);
    return false;
}

/// Lets time pass without listening.
static void rest_ms(int32_t duration_ms) {
    time_reference_t rest;
    pogobot_timer_init(&rest, duration_ms * 1000);
    while (!pogobot_timer_has_expired(&rest)) {
        msleep(20);
        pogobot_infrared_clear_message_queue();
    }
}

static void ask(void) {
    pogobot_led_setColor(0, 0, 25);
    say(QUESTION, 0);
    asked++;
    if (wait_for_answer()) {
        answered++;
        pogobot_led_setColor(0, 25, 0);
        printf("an answer after %d ms\n", (int)waited_ms);
    } else {
        pogobot_led_setColor(25, 0, 0);
    }
    rest_ms(200 + rand() % 1000);
}

static void answer(void) {
    talk_t talk;
    while (!hear(&talk) || talk.kind != QUESTION) {
    }
    rest_ms(THINKING_MS);
    say(ANSWER, talk.from);
}

#ifdef SIMULATOR
static void create_data_schema(void) {
    data_add_column_int32("asked");
    data_add_column_int32("answered");
    data_add_column_int32("waited_ms");
}

static void export_data(void) {
    data_set_value_int32("asked", asked);
    data_set_value_int32("answered", answered);
    data_set_value_int32("waited_ms", waited_ms);
}
#endif

int main(void) {
    pogobot_init();
    srand((unsigned)pogobot_helper_getRandSeed());
#ifdef SIMULATOR
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
#endif
    for (;;) {
        if (pogobot_helper_getid() % 2 == 0) {
            ask();
        } else {
            answer();
        }
    }
}
