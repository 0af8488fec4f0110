// Uses every part of the interface, as C or as C++. Its output does not depend on the compiler.
//   -DINSIDE_EXTERN_C   includes the header in an extern "C" block, as programs of earlier versions do
//   -DNO_SEMICOLON      leaves out the semicolons that DECLARE_USERDATA and REGISTER_USERDATA do not need
//   -DPLAIN_MAIN        defines main() without extern "C"
#if defined(__cplusplus) && defined(INSIDE_EXTERN_C)
extern "C" {
#include "pogobase.h"
}
#else
#include "pogobase.h"
#endif

#ifdef __cplusplus
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>
#define FROM_STD std::
#else
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#define FROM_STD
#endif

typedef struct {
    uint8_t first;
    uint32_t numbers[5];
    time_reference_t timer;
    time_reference_t stopwatch;
    message_t last;
    uint32_t heard;
} Userdata;

#ifdef NO_SEMICOLON
DECLARE_USERDATA(Userdata)
REGISTER_USERDATA(Userdata)
#else
DECLARE_USERDATA(Userdata);
REGISTER_USERDATA(Userdata);
#endif

typedef struct {
    float gain;
} Settings;

bool a_bool = false;
int8_t an_int8 = 1;
int16_t an_int16 = 2;
int32_t an_int32 = 3;
uint8_t a_uint8 = 4;
uint16_t a_uint16 = 5;
uint32_t a_uint32 = 6;
float a_float = 7.0f;
double a_double = 8.0;
float floats[3] = {1.0f, 2.0f, 3.0f};
double doubles[2] = {1.0, 2.0};
char text[8] = "before";
Settings settings = {0.5f};

#ifdef __cplusplus
extern "C" {
#endif
void user_init(void);
void user_step(void);
#ifdef __cplusplus
}
#endif

static bool send_message(void) {
    uint8_t payload[4] = {1, 2, 3, (uint8_t)pogobot_helper_getid()};
    return pogobot_infrared_sendLongMessage_omniGen(payload, sizeof(payload)) == 0;
}

static void receive_message(message_t* message) {
    mydata->last = *message;
    mydata->heard++;
}

void user_init(void) {
    FROM_STD srand((unsigned)pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = 5;
    percent_msgs_sent_per_ticks = 100;
    msg_tx_fn = send_message;
    msg_rx_fn = receive_message;
    error_codes_led_idx = -1;
    // User data are zero at the start.
    uint32_t sum = mydata->first;
    for (size_t i = 0; i < sizeof(mydata->numbers) / sizeof(mydata->numbers[0]); i++) {
        sum += mydata->numbers[i];
    }
    memset(mydata, 0, sizeof(*mydata));
    pogobot_timer_init(&mydata->timer, 100000);
    pogobot_stopwatch_reset(&mydata->stopwatch);
    if (pogobot_helper_getid() == 0) {
        printf("sum %lu\n", (unsigned long)sum);
    }
}

static void use_peripherals(void) {
    float acc[3];
    float gyro[3];
    uint8_t r, g, b;
    uint8_t directions[3];
    uint16_t powers[3];
    pogobot_imu_read(acc, gyro);
    rainbow_colormap(0, &r, &g, &b);
    printf("rainbow %u %u %u, light %d, temperature %.1f\n", r, g, b, pogobot_photosensors_read(0),
           (double)pogobot_imu_readTemp());
    hsv_to_rgb(120.0f, 1.0f, 1.0f, &r, &g, &b);
    pogobot_led_setColors(SCALE_0_255_TO_0_25(r), SCALE_0_255_TO_0_25(g), SCALE_0_255_TO_0_25(b), 1);
    qualitative_colormap(12, &r, &g, &b);
    pogobot_led_setColor(r, g, b);
    pogobot_motor_dir_mem_get(directions);
    pogobot_motor_power_mem_get(powers);
    pogobot_motor_dir_set(motorL, directions[1]);
    pogobot_motor_power_set(motorL, motorQuarter);
    pogobot_motor_set(motorR, motorHalf);
    printf("directions %u%u%u status %lu powers %u %u %u battery %d\n", directions[0], directions[1], directions[2],
           (unsigned long)pogobot_motor_dir_current_status(), powers[0], powers[1], powers[2],
           pogobot_battery_voltage_read());
    int const before = FROM_STD rand();
    FROM_STD srand(5);
    int const first = FROM_STD rand();
    FROM_STD srand(5);
    printf("rand %s %s\n", before >= 0 ? "positive" : "negative", FROM_STD rand() == first ? "repeats" : "differs");
}

void user_step(void) {
    if (pogobot_helper_getid() != 0) {
        return;
    }
    if (pogobot_ticks == 5) {
        use_peripherals();
        FROM_STD printf("std %d\n", 1);
        FROM_STD puts("puts");
        FROM_STD putchar('p');
        FROM_STD putchar('\n');
    }
    if (pogobot_timer_has_expired(&mydata->timer)) {
        pogobot_timer_offset_origin_microseconds(&mydata->timer, 10000000);
        printf("timer after %ld us at %lu ms, %lu ticks\n",
               (long)pogobot_stopwatch_get_elapsed_microseconds(&mydata->stopwatch),
               (unsigned long)current_time_milliseconds(), (unsigned long)pogobot_ticks);
        printf("heard %s, last of type %d from %d, %u bytes: %u %u %u %u\n",
               mydata->heard > 0 ? "something" : "nothing", mydata->last.header._packet_type,
               mydata->last.header._sender_id, mydata->last.header.payload_length, mydata->last.payload[0],
               mydata->last.payload[1], mydata->last.payload[2], mydata->last.payload[3]);
    }
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(a_bool);
    init_from_configuration(an_int8);
    init_from_configuration(an_int16);
    init_from_configuration(an_int32);
    init_from_configuration(a_uint8);
    init_from_configuration(a_uint16);
    init_from_configuration(a_uint32);
    init_from_configuration(a_float);
    init_from_configuration(a_double);
    init_from_configuration(settings.gain);
    init_array_from_configuration(floats);
    init_array_from_configuration(doubles);
    init_array_from_configuration(text);
    printf("read %d %d %d %ld %u %u %lu %g %g %g [%g %g %g] [%g %g] %s\n", a_bool, an_int8, an_int16, (long)an_int32,
           a_uint8, a_uint16, (unsigned long)a_uint32, (double)a_float, a_double, (double)settings.gain,
           (double)floats[0], (double)floats[1], (double)floats[2], doubles[0], doubles[1], text);
}

static void create_data_schema(void) {
    data_add_column_int32("heard");
}

static void export_data(void) {
    enable_data_export();
    data_set_value_int32("heard", (int32_t)mydata->heard);
}

static void global_step(void) {
    if (pogobot_ticks == 6) {
        printf("%lu robots, category %s\n", (unsigned long)get_nb_robots(), get_current_robot_category());
    }
}

static void robot_end(void) {
    if (pogobot_helper_getid() == 0) {
        printf("end of %s\n", current_robot_category_is("robots") ? "a robot" : "something");
    }
}
#endif

#if defined(__cplusplus) && !defined(PLAIN_MAIN)
extern "C"
#endif
    int
    main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    pogobot_start(default_walls_user_init, default_walls_user_step, "walls");
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    SET_CALLBACK(callback_global_step, global_step);
    SET_CALLBACK(callback_robot_end, robot_end);
    return POGOSIM_VERSION_ATLEAST(0, 10, 0) && STATIC_STRCMP("a", "a") == 0 ? 0 : 1;
}
