// A program that makes one of a beginner's slips, which `kind` names, at each tick from tick 10 on.
#include "pogobase.h"

typedef struct {
    uint8_t received;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

char kind[32] = "nothing";
uint32_t turn_duration = 300;
float late = 0.0f;
float vector[2] = {0.0f, 0.0f};

static bool is(char const* name) {
    return strcmp(kind, name) == 0;
}

static bool send(void) {
    uint8_t message[400] = {0};
    return pogobot_infrared_sendShortMessage_omni(message, is("long_message") ? 383 : 3) == 0;
}

static void receive(message_t* message) {
    (void)message;
    mydata->received++;
}

void user_init(void) {
    max_nb_processed_msg_per_tick = is("reads_none") ? 0 : 20;
    percent_msgs_sent_per_ticks = is("sends_never") ? 0 : is("sends_too_often") ? 150 : 100;
    msg_tx_fn = send;
    msg_rx_fn = is("deaf") || is("polls") ? NULL : receive;
    main_loop_hz = is("slow") && pogobot_helper_getid() % 2 == 0 ? 1 : 60;
}

void user_step(void) {
    if (pogobot_ticks < 10) {
        return;
    }
    if (is("negative_power")) {
        pogobot_motor_set(motorL, -500);
    } else if (is("large_power")) {
        pogobot_motor_set(motorL, 2000);
    } else if (is("motor_3")) {
        pogobot_motor_set((motor_id)3, motorFull);
    } else if (is("led_5")) {
        pogobot_led_setColors(25, 0, 0, 5);
    } else if (is("sensor_3")) {
        pogobot_photosensors_read(3);
    } else if (is("polls")) {
        pogobot_infrared_clear_message_queue();
        pogobot_infrared_update();
        pogobot_infrared_message_available();
    } else if (is("late_reading")) {
        init_from_configuration(late);
    }
}

static void global_setup(void) {
    init_from_configuration(turn_duration);
    init_array_from_configuration(vector);
    if (is("setup_of_userdata")) {
        mydata->received = 7;
    }
}

static void create_data_schema(void) {
    if (is("empty_column") || is("unset_columns")) {
        data_add_column_int8("age");
    }
    if (is("unset_columns")) {
        data_add_column_int8("size");
        data_add_column_string("name");
    }
}

static void export_data(void) {
    data_set_value_int8("size", 3);
}

int main(void) {
    init_array_from_configuration(kind);
    if (!is("no_init") && !is("late_init")) {
        pogobot_init();
    }
    if (is("wrong_category")) {
        pogobot_start(user_init, user_step, "robot");
        pogobot_start(user_init, user_step, "predators");
    } else if (!is("no_start")) {
        pogobot_start(user_init, user_step);
    }
    if (is("late_init")) {
        pogobot_init();
    }
    if (is("two_starts")) {
        pogobot_start(user_init, user_step);
    }
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    if (is("unset_columns")) {
        SET_CALLBACK(callback_export_data, export_data);
    }
    return 0;
}
