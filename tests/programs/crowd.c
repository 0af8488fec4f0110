// Whatever has a program talks; whatever has motors walks at random. For scenes with every type of object.
#include "pogobase.h"

typedef struct {
    uint32_t next_turn_ms;
    int32_t heard;      // messages
    int32_t brightest;  // photosensor counts, over the run
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

static uint16_t either(uint16_t power) {
    return rand() % 3 == 0 ? motorStop : power;
}

static bool send(void) {
    uint8_t payload[4] = {1, 2, 3, 4};
    return pogobot_infrared_sendShortMessage_omni(payload, sizeof payload) == 0;
}

static void receive(message_t* message) {
    mydata->heard += message->header.payload_length == 4;
}

static void crowd_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = 10;
    percent_msgs_sent_per_ticks = 20;
    msg_rx_fn = receive;
    msg_tx_fn = send;
}

static void look_and_shine(void) {
    for (int i = 0; i < 3; i++) {
        int32_t const level = pogobot_photosensors_read((uint8_t)i);
        if (level > mydata->brightest) {
            mydata->brightest = level;
        }
    }
    pogobot_led_setColor((uint8_t)(mydata->heard % 26), 0, 25);
}

static void walk(void) {
    look_and_shine();
    if (current_time_milliseconds() >= mydata->next_turn_ms) {
        mydata->next_turn_ms = current_time_milliseconds() + 300u + (uint32_t)rand() % 2000u;
        pogobot_motor_set(motorL, either(motorFull));
        pogobot_motor_set(motorR, either(motorFull));
    }
}

static void create_data_schema(void) {
    data_add_column_int32("heard");
    data_add_column_int32("brightest");
}

static void export_data(void) {
    data_set_value_int32("heard", mydata->heard);
    data_set_value_int32("brightest", mydata->brightest);
}

int main(void) {
    static char const* const kWithMotors[] = {"robots", "guards"};
    static char const* const kWithout[] = {"walls", "strip", "pogobjects", "membranes", "active", "rectmembranes"};
    pogobot_init();
    for (unsigned i = 0; i < sizeof kWithMotors / sizeof kWithMotors[0]; i++) {
        pogobot_start(crowd_init, walk, kWithMotors[i]);
    }
    for (unsigned i = 0; i < sizeof kWithout / sizeof kWithout[0]; i++) {
        pogobot_start(crowd_init, look_and_shine, kWithout[i]);
    }
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
