// Robots that drive, talk and count what they hear, without a warm-up: for bench_large.
#include "pogobase.h"

typedef struct {
    uint32_t heard;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

static bool send_message(void) {
    uint16_t id = pogobot_helper_getid();
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&id, sizeof(id)) == 0;
}

static void process_message(message_t* message) {
    (void)message;
    mydata->heard++;
}

static void user_init(void) {
    main_loop_hz = 60;
    percent_msgs_sent_per_ticks = 20;
    msg_tx_fn = send_message;
    msg_rx_fn = process_message;
    srand(pogobot_helper_getRandSeed());
}

static void user_step(void) {
    bool const turns = mydata->heard % 16 == 1;
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, turns ? motorStop : motorFull);
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
