// Probes: how many infrared messages get through?
//
// Shows: measuring the communication model of the simulator the way it was measured on real robots, short messages of a
// chosen size, columns of its own in the data file.
//
// Robot 0 stands in the middle, its neighbours around it. All send short messages of `payload_size` bytes with
// `send_percent` % chance per tick. Each robot counts what it sends, and each neighbour counts what it hears of robot
// 0, a message that arrives at two of its faces once. The share of robot 0's messages that a neighbour hears is the
// reception probability: received / robot 0's sent at the same time.
//
//     ./examples/probes/probes -c conf/probes.yaml --set objects.robots.nb=7 --set parameters.send_percent=50
#include "pogobase.h"

#define FOCAL_ROBOT 0
#define MIN_PAYLOAD_SIZE 3

// The first bytes of each payload; the rest is padding.
typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
    uint8_t number;  // of the message, counted by the sender
} probe_t;

typedef struct {
    uint32_t sent;
    uint32_t received;    // from the focal robot, copies counted once
    uint8_t last_number;  // of the focal robot's messages
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
uint16_t payload_size = 3;  // bytes, 3 to MAX_PAYLOAD_SIZE_BYTES
uint8_t send_percent = 50;  // chance (%) to send in a tick

static bool send_message(void) {
    uint8_t payload[MAX_PAYLOAD_SIZE_BYTES] = {0};
    mydata->sent++;
    probe_t const probe = {.sender_id = pogobot_helper_getid(), .number = (uint8_t)mydata->sent};
    memcpy(payload, &probe, sizeof(probe));
    return pogobot_infrared_sendShortMessage_omni(payload, payload_size) == 0;
}

static void process_message(message_t* message) {
    if (message->header.payload_length < sizeof(probe_t)) {
        return;
    }
    probe_t probe;
    memcpy(&probe, message->payload, sizeof(probe));
    bool const copy = mydata->received > 0 && probe.number == mydata->last_number;
    if (probe.sender_id == FOCAL_ROBOT && !copy) {
        mydata->received++;
        mydata->last_number = probe.number;
    }
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = 100;  // all of them
    percent_msgs_sent_per_ticks = send_percent;
    msg_rx_fn = process_message;
    msg_tx_fn = send_message;
}

void user_step(void) {
    // Blue for the focal robot; the others shine green each time they have heard it.
    bool const focal = pogobot_helper_getid() == FOCAL_ROBOT;
    pogobot_led_setColor(0, focal ? 0 : (uint8_t)(25 * (mydata->received % 2)), focal ? 25 : 0);
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(payload_size);
    check_parameter(payload_size, MIN_PAYLOAD_SIZE, MAX_PAYLOAD_SIZE_BYTES);
    init_from_configuration(send_percent);
    check_parameter(send_percent, 0, 100);
}

static void create_data_schema(void) {
    data_add_column_int32("sent");
    data_add_column_int32("received");
}

static void export_data(void) {
    data_set_value_int32("sent", mydata->sent);
    data_set_value_int32("received", mydata->received);
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
