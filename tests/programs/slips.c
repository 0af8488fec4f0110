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
    percent_msgs_sent_per_ticks = is("sends_never") || is("sends_itself") ? 0 : is("sends_too_often") ? 150 : 100;
    msg_tx_fn = send;
    msg_rx_fn = is("deaf") || is("polls") ? NULL : receive;
    main_loop_hz = is("slow") && pogobot_helper_getid() % 2 == 0 ? 1 : 60;
    error_codes_led_idx = is("error_led_7") ? 7 : 3;
}

// Arguments of functions of the robot: what is wrong with them is said once for each function and kind of mistake.
static void pass_odd_argument(void) {
    uint8_t text[1000] = {0};
    uint8_t r = 0, g = 0, b = 0;
    uint8_t directions[3] = {0, 1, 7};
    uint16_t powers[3] = {0, 2000, 0};
    char page[POGOBOT_USER_FLASH_PAGE_SIZE] = {0};
    time_reference_t watch;
    message_t long_message = {.header = {._emitting_power_list = 255, .payload_length = 383}};
    message_t powerless_message = {.header = {.payload_length = 3}};
    short_message_t short_message = {.header = {.payload_length = 383}};
    if (is("motor_power")) {
        pogobot_motor_set(motorL, 5000);
        pogobot_motor_set(motorR, 1024);
        pogobot_motor_power_set(motorL, 1024);
    } else if (is("negative_power")) {
        pogobot_motor_set(motorL, -500);
    } else if (is("motor_3")) {
        pogobot_motor_set((motor_id)3, motorFull);
    } else if (is("direction_2")) {
        pogobot_motor_dir_set(motorL, 2);
    } else if (is("direction_of_motor_3")) {
        pogobot_motor_dir_set((motor_id)3, 1);
    } else if (is("stored_direction")) {
        pogobot_motor_dir_mem_set(directions);
    } else if (is("stored_power")) {
        pogobot_motor_power_mem_set(powers);
    } else if (is("nowhere_to_read_to")) {
        pogobot_motor_power_mem_get(NULL);
    } else if (is("led_5")) {
        pogobot_led_setColors(25, 0, 0, 5);
    } else if (is("sensor_3")) {
        pogobot_photosensors_read(3);
    } else if (is("write_of_page_5888")) {
        write_page_flash(POGOBOT_USER_FLASH_PAGE_COUNT, page);
    } else if (is("read_of_page_65535")) {
        read_page_flash(UINT16_MAX, page);
    } else if (is("direction_5")) {
        pogobot_infrared_sendShortMessage_uni((ir_direction)5, text, 3);
    } else if (is("direction_-1")) {
        pogobot_infrared_sendLongMessage_uniSpe((ir_direction)-1, text, 3);
    } else if (is("long_long_message")) {
        pogobot_infrared_sendLongMessage_omniSpe(text, 1000);
    } else if (is("raw_long_message")) {
        pogobot_infrared_sendRawLongMessage(&long_message);
    } else if (is("raw_message_without_power")) {
        pogobot_infrared_sendRawLongMessage(&powerless_message);
    } else if (is("raw_short_message")) {
        pogobot_infrared_sendRawShortMessage(ir_all, &short_message);
    } else if (is("no_message")) {
        pogobot_infrared_sendShortMessage_omni(NULL, 3);
    } else if (is("power_4")) {
        pogobot_infrared_set_power(4);
    } else if (is("receiver_4")) {
        slip_error_counter_s counter;
        pogobot_infrared_get_receiver_error_counter(&counter, 4);
    } else if (is("sleep_-1")) {
        msleep(-1);
    } else if (is("old_stopwatch")) {
        pogobot_stopwatch_reset(&watch);
        for (int i = 0; i < 3; i++) {
            pogobot_stopwatch_offset_origin_microseconds(&watch, -1000000000);
        }
        pogobot_stopwatch_get_elapsed_microseconds(&watch);
    } else if (is("hue")) {
        hsv_to_rgb(400.0f, 1.0f, 1.0f, &r, &g, &b);
    } else if (is("hidden_row")) {
        disable_data_export();
    }
}

void user_step(void) {
    if (pogobot_ticks < 10) {
        return;
    }
    pass_odd_argument();
    if (is("dark")) {
        pogobot_photosensors_read(0);
    } else if (is("faster")) {
        main_loop_hz = 200;
    } else if (is("polls")) {
        pogobot_infrared_clear_message_queue();
        pogobot_infrared_update();
        pogobot_infrared_message_available();
    } else if (is("sends_itself")) {
        msg_tx_fn();
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
    if (is("large_half")) {
        data_add_column_float16("half");
    }
    if (is("unset_columns")) {
        data_add_column_int8("size");
        data_add_column_string("name");
    }
}

static void export_data(void) {
    if (is("large_half")) {
        data_set_value_float16("half", 65519.0f);
        data_set_value_float16("half", 1e6f);
        return;
    }
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
    if (is("unset_columns") || is("large_half")) {
        SET_CALLBACK(callback_export_data, export_data);
    }
    return 0;
}
