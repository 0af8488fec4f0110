// Robots that drive and blink, with 4 kB of variables of which they change a few in each step: for own_variables.py.
// The same three times: in USERDATA; as globals (-DIN_GLOBALS, with robot_memory: own); for the SDK (-DIN_SDK).
#ifdef IN_SDK
#include "pogobot.h"
#else
#include "pogobase.h"
#endif

typedef struct {
    uint32_t steps;
    int32_t power;
    uint8_t history[4096 - 8];
} variables_t;

#if defined(IN_SDK) || defined(IN_GLOBALS)
static variables_t variables;
static variables_t* const own = &variables;
#else
typedef variables_t USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);
#define own mydata
#endif

static void step(void) {
    own->steps++;
    own->history[own->steps % 64] = (uint8_t)own->steps;
    own->power = own->steps % 128 < 64 ? motorFull : motorFull / 2;
    pogobot_motor_set(motorL, own->power);
    pogobot_motor_set(motorR, motorFull);
    pogobot_led_setColor(own->steps % 25, 0, 0);
}

#ifdef IN_SDK
int main(void) {
    pogobot_init();
    for (;;) {
        time_reference_t turn;
        pogobot_stopwatch_reset(&turn);
        step();
        msleep((1000000 / 60 - pogobot_stopwatch_get_elapsed_microseconds(&turn)) / 1000);
    }
}
#else
static void init(void) {
    main_loop_hz = 60;
}

int main(void) {
    pogobot_init();
    pogobot_start(init, step);
    return 0;
}
#endif
