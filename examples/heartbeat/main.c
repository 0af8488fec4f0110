// Heartbeats: each robot says that it is there, and counts what it hears.
//
// Shows: what the main loop does for a program that sends and receives messages. The example heartbeat_sdk is the same
// program as it is written for the robots' SDK alone; see docs/porting.md.
//
//     ./examples/heartbeat/heartbeat -c conf/heartbeat.yaml
#include "pogobase.h"

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
} heartbeat_t;

// Variables of one robot.
typedef struct {
    uint32_t heard;
    uint16_t last_sender;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

static bool send(void) {
    heartbeat_t heartbeat = {.sender_id = pogobot_helper_getid()};
    pogobot_infrared_sendShortMessage_omni((uint8_t*)&heartbeat, sizeof(heartbeat));
    return true;
}

static void receive(message_t* message) {
    if (message->header.payload_length == sizeof(heartbeat_t)) {
        heartbeat_t heartbeat;
        memcpy(&heartbeat, message->payload, sizeof(heartbeat));
        mydata->last_sender = heartbeat.sender_id;
        mydata->heard++;
    }
}

void user_init(void) {
    srand((unsigned)pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    percent_msgs_sent_per_ticks = 50;
    max_nb_processed_msg_per_tick = 255;  // all
    msg_tx_fn = send;
    msg_rx_fn = receive;
}

void user_step(void) {
    if (pogobot_ticks % main_loop_hz == 0 && pogobot_helper_getid() == 0) {
        printf("%lu sent, %lu heard, the last one from robot %u\n", (unsigned long)nb_msgs_sent,
               (unsigned long)mydata->heard, mydata->last_sender);
    }
    pogobot_led_setColor(mydata->heard % 26, 0, 0);
}

#ifdef SIMULATOR
static void create_data_schema(void) {
    data_add_column_int32("sent");
    data_add_column_int32("heard");
}

static void export_data(void) {
    data_set_value_int32("sent", nb_msgs_sent);
    data_set_value_int32("heard", mydata->heard);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
