// Robots whose function does not return, in the way `how` says.
#include "pogobase.h"

typedef struct {
    uint32_t turns;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

char how[32] = "msleep";

static bool is(char const* name) {
    return strcmp(how, name) == 0;
}

static void loop(void) {
    for (;;) {
        mydata->turns++;
        if (is("update")) {
            pogobot_infrared_update();
            msleep(10);
        } else if (is("clock")) {
            current_time_milliseconds();
        } else if (is("motor")) {
            pogobot_motor_set(motorL, 500);
        } else if (is("sleep")) {
            sleep(1);  // here it sleeps
        } else {
            msleep(10);  // here it waits
        }
    }
}

static bool send(void) {
    if (is("msg_tx_fn")) {
        loop();
    }
    return true;
}

static void receive(message_t* message) {
    (void)message;
    if (is("msg_rx_fn")) {
        loop();
    }
}

void user_init(void) {
    msg_tx_fn = is("no callbacks") ? NULL : send;
    msg_rx_fn = is("no callbacks") ? NULL : receive;
    percent_msgs_sent_per_ticks = 100;
    if (is("user_init")) {
        for (;;) {
            pogobot_infrared_update();
        }
    }
}

void user_step(void) {
    uint8_t message = 1;
    pogobot_infrared_sendShortMessage_omni(&message, 1);
    bool const is_first = pogobot_helper_getid() == 0;
    if (is("long steps")) {
        for (int i = 0; i < 20; i++) {
            msleep(1000);
        }
    } else if (is("dance")) {
        for (int i = 0; i < 140; i++) {
            pogobot_led_setColor(i % 2 == 0 ? 25 : 0, 0, 0);
            msleep(500);
        }
    } else if (is("long sleep")) {
        msleep(1000000);
    } else if (is("late")) {
        if (pogobot_ticks == 50 && !is_first) {
            loop();
        }
    } else if (is("slower")) {
        for (int i = 0; i < 100; i++) {
            msleep(10);
        }
        if (pogobot_ticks > 0) {
            loop();
        }
    } else if (is("now and then")) {
        for (int i = 0; i < (is_first ? 8 : 2); i++) {
            msleep(1000);
        }
    } else if (!is("msg_tx_fn") && !is("msg_rx_fn")) {
        loop();
    }
}

int main(void) {
    init_array_from_configuration(how);
    pogobot_init();
    pogobot_start(user_init, user_step);
    pogobot_start(user_init, user_step, "others");
    return 0;
}
