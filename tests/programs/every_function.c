// Calls every function of the robots' library, and prints what it gives: for a comparison with the same program as
// firmware. Two robots face each other, so what one sends the other receives.
#include "pogobase.h"

typedef struct {
    time_reference_t clock;
    time_reference_t timer;
    message_t message;
} USERDATA;

DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

static void say(char const* what, long value) {
    printf("%lu %s %ld\n", (unsigned long)pogobot_ticks, what, value);
}

static void say_float(char const* what, float value) {
    say(what, (long)(value * 1000.0F));
}

static void lights_and_motors(void) {
    uint8_t directions[3] = {9, 9, 9};
    uint16_t powers[3] = {9, 9, 9};
    pogobot_led_setColor(25, 50, 75);
    pogobot_led_setColors(1, 2, 3, 4);
    pogobot_led_setColors(255, 0, 255, 5);  // no such LED
    pogobot_motor_power_set(motorR, 300);
    pogobot_motor_set(motorL, 400);
    pogobot_motor_power_set(motorB, 5000);  // too much
    pogobot_motor_set((motor_id)7, 100);    // no such motor
    pogobot_motor_dir_set(motorL, 1);
    pogobot_motor_dir_set(motorR, 7);
    say("dir", (long)pogobot_motor_dir_current_status());
    say("dir_mem_get", pogobot_motor_dir_mem_get(directions));
    directions[0] = 1;
    directions[1] = 0;
    directions[2] = 1;
    say("dir_mem_set", pogobot_motor_dir_mem_set(directions));
    say("dir_mem_get", pogobot_motor_dir_mem_get(directions));
    say("power_mem_get", pogobot_motor_power_mem_get(powers));
    powers[0] = 100;
    powers[1] = 200;
    powers[2] = 3000;
    say("power_mem_set", pogobot_motor_power_mem_set(powers));
    say("power_mem_get", pogobot_motor_power_mem_get(powers));
    for (int i = 0; i < 3; i++) {
        say("direction", directions[i]);
        say("power", powers[i]);
    }
}

static void sensors(void) {
    float acceleration[3], gyro[3];
    int16_t field[3] = {0, 0, 0};
    for (uint8_t i = 0; i < 4; i++) {
        say("photosensor", pogobot_photosensors_read(i));
    }
    say("battery", pogobot_battery_voltage_read());
    pogobot_imu_read(acceleration, gyro);
    for (int i = 0; i < 3; i++) {
        say_float("acceleration", acceleration[i]);
        say_float("gyro", gyro[i]);
    }
    say_float("temperature", pogobot_imu_readTemp());
    say("magn_init", magn_init());
    magn_begin();
    say("magn_read", magn_read_XYZ(&field[0], &field[1], &field[2], 50));
    say("field", field[0]);
    say("field", field[1]);
    say("field", field[2]);
    magn_end();
}

static void clocks(void) {
    say("elapsed", pogobot_stopwatch_get_elapsed_microseconds(&mydata->clock));
    say("lap", pogobot_stopwatch_lap(&mydata->clock));
    pogobot_stopwatch_offset_origin_microseconds(&mydata->clock, -2500);
    say("elapsed", pogobot_stopwatch_get_elapsed_microseconds(&mydata->clock));
    pogobot_stopwatch_reset(&mydata->clock);
    say("elapsed", pogobot_stopwatch_get_elapsed_microseconds(&mydata->clock));
    pogobot_timer_init(&mydata->timer, 3000);
    say("expired", pogobot_timer_has_expired(&mydata->timer));
    say("remaining", pogobot_timer_get_remaining_microseconds(&mydata->timer));
    pogobot_timer_offset_origin_microseconds(&mydata->timer, 2000);
    say("remaining", pogobot_timer_get_remaining_microseconds(&mydata->timer));
    pogobot_timer_wait_for_expiry(&mydata->timer);
    say("expired", pogobot_timer_has_expired(&mydata->timer));
    msleep(7);
    say("elapsed", pogobot_stopwatch_get_elapsed_microseconds(&mydata->clock));
    msleep(-7);
    usleep(4200);
    say("elapsed", pogobot_stopwatch_get_elapsed_microseconds(&mydata->clock));
    pli_timer_sleep_stopwatch_init();
    say("milliseconds", (long)current_time_milliseconds());
}

static void flash(void) {
    char page[256];
    for (int i = 0; i < 256; i++) {
        page[i] = (char)(i + pogobot_helper_getid());
    }
    write_page_flash(7, page);
    write_page_flash(5887, page);
    write_page_flash(5888, page);  // no such page
    for (int i = 0; i < 256; i++) {
        page[i] = 1;
    }
    read_page_flash(7, page);
    say("flash", (uint8_t)page[3]);
    read_page_flash(8, page);
    say("flash", (uint8_t)page[3]);
    read_page_flash(6000, page);
    say("flash", (uint8_t)page[3]);
    erase_write_section_flash();
    read_page_flash(7, page);
    say("flash", (uint8_t)page[3]);
}

static void helpers(void) {
    say("id", pogobot_helper_getid());
    say("seed", pogobot_helper_getRandSeed());
    say("seed", pogobot_helper_getRandSeed());
    pogobot_helper_print_version();
    srand(42);
    say("rand", rand());
    say("rand", rand());
    printf("no end of line: ");
    printf("%d%%\n", 50);
}

static void send(void) {
    static uint8_t const text[] = "hello";
    uint8_t long_text[400] = {0};
    uint8_t bytes[5];
    short_message_t short_message = {.header = {.payload_length = 2}, .payload = {7, 8}};
    for (unsigned i = 0; i < sizeof(bytes); i++) {
        bytes[i] = text[i];
    }
    mydata->message.header.payload_length = 3;
    mydata->message.header._packet_type = ir_t_user;
    mydata->message.header._emitting_power_list = 0xFF;
    mydata->message.header._sender_ir_index = ir_all;
    mydata->message.payload[0] = 200;
    pogobot_infrared_set_power(pogobot_infrared_emitter_power_max);
    switch (pogobot_ticks) {
        case 20:
            say("sent", (long)pogobot_infrared_sendLongMessage_omniGen(bytes, 5));
            break;
        case 21:
            say("sent", (long)pogobot_infrared_sendLongMessage_omniSpe(bytes, 4));
            break;
        case 22:
            say("sent", (long)pogobot_infrared_sendLongMessage_uniSpe(ir_front, bytes, 3));
            break;
        case 23:
            say("sent", (long)pogobot_infrared_sendLongMessage_uniSpe((ir_direction)9, bytes, 3));
            break;
        case 24:
            say("sent", (long)pogobot_infrared_sendShortMessage_omni(bytes, 2));
            break;
        case 25:
            say("sent", (long)pogobot_infrared_sendShortMessage_uni(ir_front, bytes, 1));
            break;
        case 26:
            say("sent", (long)pogobot_infrared_sendShortMessage_uni(ir_back, bytes, 1));
            break;
        case 27:
            say("sent", (long)pogobot_infrared_sendRawLongMessage(&mydata->message));
            break;
        case 28:
            say("sent", (long)pogobot_infrared_sendRawShortMessage(ir_front, &short_message));
            break;
        case 29:
            say("sent", (long)pogobot_infrared_sendLongMessage_omniGen(long_text, 400));
            break;  // too long
        case 30:
            say("sent", (long)pogobot_infrared_sendShortMessage_omni(bytes, 0));
            break;
        case 31:
            pogobot_infrared_set_power(pogobot_infrared_emitter_power_null);
            break;
        case 32:
            pogobot_infrared_set_power(77);
            break;  // no such power
        default:
            break;
    }
}

static void receive(void) {
    slip_error_counter_s errors;
    pogobot_infrared_update();
    while (pogobot_infrared_message_available() > 0) {
        message_t message;
        pogobot_infrared_recover_next_message(&message);
        say("type", message.header._packet_type);
        say("powers", message.header._emitting_power_list);
        say("sender", message.header._sender_id);
        say("from", message.header._sender_ir_index);
        say("to", message.header._receiver_ir_index);
        say("length", message.header.payload_length);
        for (int i = 0; i < message.header.payload_length; i++) {
            say("byte", message.payload[i]);
        }
    }
    say("available", pogobot_infrared_message_available());
    pogobot_infrared_clear_message_queue();
    pogobot_infrared_get_receiver_error_counter(&errors, 0);
    say("errors", (long)errors.crc_mismatch_counter);
    pogobot_infrared_reset_receiver_error_counter();
    say("dropped", (long)pogobot_infrared_get_queue_drop_count());
    say("malformed", (long)pogobot_infrared_get_malformed_count());
    say("muted", is_muted());
}

void user_init(void) {
    pogobot_stopwatch_reset(&mydata->clock);
    say("init", pogobot_helper_getid());
}

void user_step(void) {
    switch (pogobot_ticks) {
        case 3:
            lights_and_motors();
            break;
        case 6:
            sensors();
            break;
        case 9:
            clocks();
            break;
        case 12:
            flash();
            break;
        case 15:
            helpers();
            break;
        case 18:
            sensors();
            break;
        case 50:
            pogobot_infrared_ll_init();
            break;
        case 51:
            IR_reset_interrupt_flags();
            pogobot_infrared_recover_next_message(&mydata->message);  // there is none
            break;
        case 55:
            sleep(1);
            break;
        case 60:
            say("end", 0);
            break;
        default:
            break;
    }
    if (pogobot_ticks >= 20 && pogobot_ticks < 45) {
        send();
        receive();
    }
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
