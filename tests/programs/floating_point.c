// Robots that change the mode of the floating-point unit, in the way `how` says, in the function that `where` names. In
// user_step, every second robot does.
#include <fenv.h>
#include "pogobase.h"
#ifdef __x86_64__
#include <xmmintrin.h>
#endif
typedef struct {
    int32_t seen;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
char how[32] = "nothing";
char where[32] = "user_step";
static void change(char const* here) {
    if (strcmp(where, here) != 0 || (strcmp(here, "user_step") == 0 && pogobot_helper_getid() % 2 == 0)) {
        return;
    }
    if (strcmp(how, "rounding") == 0) {
        fesetround(FE_UPWARD);
    }
#ifdef __x86_64__
    if (strcmp(how, "flush") == 0) {
        _mm_setcsr(_mm_getcsr() | 0x8040);
    } else if (strcmp(how, "flush results") == 0) {
        _mm_setcsr(_mm_getcsr() | 0x8000);
    } else if (strcmp(how, "flush operands") == 0) {
        _mm_setcsr(_mm_getcsr() | 0x0040);
    } else if (strcmp(how, "traps") == 0) {
        _mm_setcsr(_mm_getcsr() & ~0x1000U);  // an inexact result
    } else if (strcmp(how, "x87") == 0) {
        uint16_t const upward = 0x0b7f;
        __asm__ volatile("fldcw %0" : : "m"(upward));
    } else if (strcmp(how, "crash") == 0) {
        _mm_setcsr(0x7f80);
        abort();
    }
#endif
}
static void receive(message_t* m) {
    (void)m;
    mydata->seen++;
    change("msg_rx_fn");
}
static bool send(void) {
    uint8_t b = 1;
    bool s = pogobot_infrared_sendShortMessage_omni(&b, 1) == 0;
    change("msg_tx_fn");
    return s;
}
void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    msg_rx_fn = receive;
    msg_tx_fn = send;
    change("user_init");
}
void user_step(void) {
    mydata->seen += pogobot_photosensors_read(0);
    if (pogobot_ticks % 20 == 0) {
        pogobot_motor_set(motorL, 400 + rand() % 600);
        pogobot_motor_set(motorR, 400 + rand() % 600);
    }
    change("user_step");
    if (strcmp(where, "wait") == 0 && pogobot_ticks % 3 == 0) {
        change("wait");
        msleep(25);
    }
    mydata->seen += pogobot_photosensors_read(1);
}
static void global_setup(void) {
    init_array_from_configuration(how);
    init_array_from_configuration(where);
    change("global_setup");
}
static void create_data_schema(void) {
    data_add_column_int32("seen");
    change("schema");
}
static void export_data(void) {
    data_set_value_int32("seen", mydata->seen);
    change("export");
}
static void global_step(void) {
    change("global_step");
}
int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    SET_CALLBACK(callback_global_step, global_step);
    return 0;
}
