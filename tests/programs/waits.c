// Robots that wait in the middle of their program, each in the way `how` says.
#include "pogobase.h"

typedef struct {
    time_reference_t watch;
    int32_t waited_us;
    uint32_t waits;  // that are over
    uint32_t number;
    bool is_waiting;
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

char how[32] = "nothing";
int32_t wait_ms = 100;
POGO_SHARED static uint8_t message[] = "ask";

static void wait_with_timer(bool (*is_over)(time_reference_t*)) {
    time_reference_t timer;
    pogobot_timer_init(&timer, wait_ms * 1000);
    while (!is_over(&timer)) {
    }
}

static bool is_positive(time_reference_t* timer) {
    return pogobot_timer_get_remaining_microseconds(timer) <= 0;
}

static void sleep_in_small_steps(void) {
    for (int i = 0; i < wait_ms; i++) {
        msleep(1);
    }
}

static void wait_for_message(void) {
    while (pogobot_infrared_update(), !pogobot_infrared_message_available()) {
    }
    message_t received;
    pogobot_infrared_recover_next_message(&received);
    pogobot_infrared_clear_message_queue();
}

static void wait_for_darkness(void) {
    while (pogobot_photosensors_read(0) > 100) {
    }
}

// Each call has a frame of its own, with a wait at the bottom.
static uint32_t sum_to(uint32_t n) {
    volatile uint32_t own = n;
    if (n == 0) {
        msleep(wait_ms);
        return 0;
    }
    return sum_to(n - 1) + own;
}

static void call_for_ever(uint32_t n) {
    volatile uint8_t large[1000];
    large[n % sizeof(large)] = 1;
    msleep(1);
    if (wait_ms > 0) {
        call_for_ever(n + large[n % sizeof(large)]);
    }
}

static void wait(void) {
    if (strcmp(how, "msleep") == 0) {
        msleep(wait_ms);
    } else if (strcmp(how, "usleep") == 0) {
        usleep((unsigned)wait_ms * 1000);
    } else if (strcmp(how, "small sleeps") == 0) {
        sleep_in_small_steps();
    } else if (strcmp(how, "timer") == 0) {
        wait_with_timer(pogobot_timer_has_expired);
    } else if (strcmp(how, "remaining time") == 0) {
        wait_with_timer(is_positive);
    } else if (strcmp(how, "expiry") == 0) {
        time_reference_t timer;
        pogobot_timer_init(&timer, wait_ms * 1000);
        pogobot_timer_wait_for_expiry(&timer);
    } else if (strcmp(how, "stopwatch") == 0) {
        time_reference_t watch;
        pogobot_stopwatch_reset(&watch);
        while (pogobot_stopwatch_get_elapsed_microseconds(&watch) < wait_ms * 1000) {
        }
    } else if (strcmp(how, "milliseconds") == 0) {
        uint32_t const start = current_time_milliseconds();
        while (current_time_milliseconds() - start < (uint32_t)wait_ms) {
        }
    } else if (strcmp(how, "message") == 0) {
        wait_for_message();
    } else if (strcmp(how, "darkness") == 0) {
        wait_for_darkness();
    } else if (strcmp(how, "recursion") == 0) {
        mydata->number = sum_to(50);
    } else if (strcmp(how, "overflow") == 0) {
        call_for_ever(0);
    } else if (strcmp(how, "crash") == 0) {
        msleep(wait_ms);
        if (pogobot_helper_getid() == 1) {
            *(volatile int*)8 = 1;
        }
    } else if (strcmp(how, "no end") == 0) {
        for (;;) {
        }
    } else if (strcmp(how, "drive") == 0) {
        pogobot_motor_set(motorL, motorFull);
        pogobot_motor_set(motorR, motorFull);
        msleep(wait_ms);
        pogobot_motor_set(motorL, motorStop);
        pogobot_motor_set(motorR, motorStop);
        msleep(10000);
    }
}

static void send_to_all(void) {
    pogobot_infrared_sendShortMessage_omni(message, sizeof(message));
}

void user_init(void) {
    main_loop_hz = 50;
    srand((unsigned)pogobot_helper_getRandSeed());
    if (strcmp(how, "init") == 0) {
        msleep(wait_ms);
        wait_for_message();
        pogobot_led_setColor(0, 25, 0);
    }
}

void user_step(void) {
    if (pogobot_helper_getid() == 0 && (strcmp(how, "message") == 0 || strcmp(how, "init") == 0)) {
        if (pogobot_ticks == 25) {
            send_to_all();
        }
        return;
    }
    pogobot_stopwatch_reset(&mydata->watch);
    uint32_t const before = pogobot_helper_getid() + 1000;
    mydata->is_waiting = true;
    wait();
    mydata->is_waiting = false;
    mydata->waited_us = pogobot_stopwatch_get_elapsed_microseconds(&mydata->watch);
    mydata->waits++;
    if (before != pogobot_helper_getid() + 1000U) {
        printf("these are not the variables of robot %u\n", pogobot_helper_getid());
    }
}

static void global_setup(void) {
    init_from_configuration(wait_ms);
    init_string_from_configuration(how, "how", sizeof(how));
}

static void create_data_schema(void) {
    data_add_column_int32("waited_us");
    data_add_column_int32("waits");
    data_add_column_int32("number");
    data_add_column_bool("is_waiting");
    data_add_column_int32("ticks");
}

static void export_data(void) {
    data_set_value_int32("waited_us", mydata->waited_us);
    data_set_value_int32("waits", (int32_t)mydata->waits);
    data_set_value_int32("number", (int32_t)mydata->number);
    data_set_value_bool("is_waiting", mydata->is_waiting);
    data_set_value_int32("ticks", (int32_t)pogobot_ticks);
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
