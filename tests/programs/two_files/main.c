// Each robot counts in steps of its own.
#include "userdata.h"

REGISTER_USERDATA(Userdata);

void user_init(void) {}

void user_step(void) {
    count_up();
    if (pogobot_ticks == 9) {
        printf("counted to %lu\n", (unsigned long)mydata->count);
    }
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
