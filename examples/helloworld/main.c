// Hello, world: the smallest complete Pogobot program.
//
// Shows: a program's three functions (main, user_init, user_step), the variables of one robot (USERDATA), LEDs, motors,
// a stopwatch and printf.
//
// Every robot turns to one side under a blue light for ten seconds, then to the other side under a red one, and so on.
// Robot 0 greets every 1000 ticks.
//
//     ./examples/helloworld/helloworld -c conf/helloworld.yaml
#include "pogobase.h"

#define PERIOD_US 10000000  // time between two changes of side

// Every robot has its own copy of these variables. A plain global would be shared by all simulated robots.
typedef struct {
    uint8_t greeting[8];
    time_reference_t since_change;
    bool turns_left;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

static void turn_right(void) {
    pogobot_led_setColor(0, 0, 255);
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorStop);
}

static void turn_left(void) {
    pogobot_led_setColor(255, 0, 0);
    pogobot_motor_set(motorL, motorStop);
    pogobot_motor_set(motorR, motorFull);
}

// Called once, before the first step.
void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;  // calls of user_step per second

    memcpy(mydata->greeting, "HELLO", sizeof("HELLO"));
    pogobot_stopwatch_reset(&mydata->since_change);
    turn_right();
}

// Called at each tick.
void user_step(void) {
    if (pogobot_stopwatch_get_elapsed_microseconds(&mydata->since_change) >= PERIOD_US) {
        pogobot_stopwatch_offset_origin_microseconds(&mydata->since_change, PERIOD_US);
        mydata->turns_left = !mydata->turns_left;
        if (mydata->turns_left) {
            turn_left();
        } else {
            turn_right();
        }
    }

    if (pogobot_helper_getid() == 0 && pogobot_ticks % 1000 == 0) {
        printf("%s WORLD! I am robot %u. Time: %lu ms, stopwatch: %ld us, ticks: %lu\n", (char const*)mydata->greeting,
               pogobot_helper_getid(), (unsigned long)current_time_milliseconds(),
               (long)pogobot_stopwatch_get_elapsed_microseconds(&mydata->since_change), (unsigned long)pogobot_ticks);
    }
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
