// For tests of the window. The robot with id 0 says when it is clicked, and loops for a while when `busy_ms` is set.
#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include "pogobase.h"

typedef struct {
    uint32_t clicks;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

uint32_t busy_ms = 0;  // wall-clock time of robot 0's step at tick `busy_at`
uint32_t busy_at = 10;
bool drives = true;
bool leaves_folder = false;

static bool send_message(void) {
    uint8_t const nothing = 0;
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&nothing, 1) == 0;
}

static void wait_busily(uint32_t milliseconds) {
    struct timespec start;
    struct timespec now;
    timespec_get(&start, TIME_UTC);
    do {
        timespec_get(&now, TIME_UTC);
    } while ((now.tv_sec - start.tv_sec) * 1000 + (now.tv_nsec - start.tv_nsec) / 1000000 < (long)milliseconds);
}

void user_init(void) {
    msg_tx_fn = send_message;
    uint16_t const id = pogobot_helper_getid();
    pogobot_led_setColor(id % 3 == 0 ? 25 : 0, id % 3 == 1 ? 25 : 0, id % 3 == 2 ? 25 : 0);
    pogobot_led_setColors(25, 0, 0, 1);
    pogobot_led_setColors(0, 25, 0, 2);
    pogobot_led_setColors(0, 0, 25, 3);
    pogobot_led_setColors(25, 25, 0, 4);
}

void user_step(void) {
    pogobot_motor_set(motorL, drives ? motorFull : motorStop);
    pogobot_motor_set(motorR, drives ? motorHalf : motorStop);
    if (pogobot_helper_getid() == 0 && busy_ms > 0 && pogobot_ticks == busy_at) {
        printf("busy\n");
        wait_busily(busy_ms);
        printf("no longer busy\n");
    }
}

#ifdef SIMULATOR
static void on_click(void) {
    mydata->clicks++;
    printf("clicked %lu times\n", (unsigned long)mydata->clicks);
}

static void global_setup(void) {
    init_from_configuration(busy_ms);
    init_from_configuration(busy_at);
    init_from_configuration(drives);
    init_from_configuration(leaves_folder);
    if (leaves_folder && chdir("/") != 0) {
        printf("cannot leave the folder\n");
    }
}

static void create_data_schema(void) {
    data_add_column_int32("sent");
    data_add_column_int32("clicks");
}

static void export_data(void) {
    data_set_value_int32("sent", (int32_t)nb_msgs_sent);
    data_set_value_int32("clicks", (int32_t)mydata->clicks);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    SET_CALLBACK(callback_robot_click, on_click);
    return 0;
}
