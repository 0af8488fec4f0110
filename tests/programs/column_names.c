// A column of any name, columns whose values are difficult in text, and messages whose bytes are.
#include <math.h>

#include "pogobase.h"

#ifndef COLUMN
#define COLUMN "number"
#endif

typedef struct {
    int unused;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

static bool send_message(void) {
    uint8_t payload[3] = {0, 255, 10};
    return pogobot_infrared_sendShortMessage_omni(payload, sizeof(payload)) == 0;
}

void user_init(void) {
    percent_msgs_sent_per_ticks = 20;
    msg_tx_fn = send_message;
}
void user_step(void) {}

static void create_data_schema(void) {
    data_add_column_int32(COLUMN);
    data_add_column_string("word");
    data_add_column_float16("half");
    data_add_column_double("third");
    data_add_column_bool("even");
}

static void export_data(void) {
    uint16_t const id = pogobot_helper_getid();
    data_set_value_int32(COLUMN, 100 * id + (int32_t)(pogobot_ticks % 7));
    if (id > 0) {  // else null
        data_set_value_string("word", id > 1 ? "a, \"b\"\nc" : "");
        data_set_value_float16("half", 0.1f);
        data_set_value_double("third", id > 1 ? (double)pogobot_ticks / 3.0 : NAN);
        data_set_value_bool("even", pogobot_ticks % 2 == 0);
    }
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
