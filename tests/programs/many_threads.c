// Robots that share nothing, so that several threads may run them. `kind` says what robots do in tick 10: those whose
// id is a multiple of `every`, but not 0.
#include <math.h>

#include "pogobase.h"

#define TICK_OF_THE_DEED 10

typedef struct {
    uint32_t heard;
    float way;
    char* note;
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

static char kind[40] = "nothing";
static uint16_t every = 100;
static int32_t limit = 5;

static bool is(char const* name) {
    return strcmp(kind, name) == 0;
}

// Allocates, as the C library does under a lock.
static void say(char const* what) {
    mydata->note = realloc(mydata->note, strlen(what) + 20);
    snprintf(mydata->note, strlen(what) + 20, "%s %lu", what, (unsigned long)mydata->heard);
    printf("%s\n", mydata->note);
}

static void hear(message_t* message) {
    mydata->heard += message->payload[0];
}

static bool tell(void) {
    uint8_t text[4] = {(uint8_t)pogobot_helper_getid(), 1, 2, 3};
    pogobot_infrared_sendShortMessage_omni(text, 1 + pogobot_ticks % 4);
    return true;
}

void user_init(void) {
    srand((unsigned)pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    msg_rx_fn = hear;
    msg_tx_fn = tell;
    percent_msgs_sent_per_ticks = 50;
}

static void do_deed(void) {
    int volatile zero = 0;
    if (is("write_to_null")) {
        int volatile* volatile nowhere = NULL;
        say("going to write");
        *nowhere = 1;
    } else if (is("divide_by_zero")) {
        limit = 10 / zero;
    } else if (is("one_crashes_beside_one_that_loops")) {
        int volatile* volatile nowhere = NULL;
        while (pogobot_helper_getid() == 300) {
            zero = 0;
        }
        if (pogobot_helper_getid() == 299) {
            for (uint32_t volatile i = 0; i < 300000000; i++) {  // until the other one is at it
            }
            *nowhere = 1;
        }
    } else if (is("abort")) {
        abort();
    } else if (is("loop_for_ever")) {
        for (;;) {
            zero = 0;
        }
    } else if (is("exit_with_7")) {
        exit(7);
    } else if (is("set_unknown_column")) {
        data_set_value_int8("nobody declared this", 1);
    } else if (is("stop_simulation")) {
        stop_simulation();
    } else if (is("change_a_parameter")) {
        limit++;
    } else if (is("read_a_parameter_again")) {
        init_from_configuration(limit);
    } else if (is("take_a_message_that_is_not_there")) {
        message_t message;
        pogobot_infrared_clear_message_queue();
        pogobot_infrared_recover_next_message(&message);
    }
}

void user_step(void) {
    if (rand() % 4 == 0) {
        pogobot_motor_set(motorL, (uint16_t)(rand() % 1023));
        pogobot_motor_set(motorR, (uint16_t)(rand() % 1023));
        pogobot_led_setColor((uint8_t)rand(), 0, 5);
    }
    mydata->way += sqrtf((float)(pogobot_photosensors_read(0) + limit));
    if (rand() % 200 == 0) {
        say(rand() % 2 ? "heard so far:" : "two\nlines, and");
        printf("and a part, ");
    }
    if (pogobot_ticks == TICK_OF_THE_DEED && pogobot_helper_getid() > 0 && pogobot_helper_getid() % every == 0) {
        do_deed();
    }
}

static void declare(void) {
    data_add_column_double("way");
}

static void export_data(void) {
    data_set_value_double("way", mydata->way);
}

static void setup(void) {
    init_array_from_configuration(kind);
    init_from_configuration(every);
    init_from_configuration(limit);
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, setup);
    SET_CALLBACK(callback_create_data_schema, declare);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
