// A robot that writes behind the last array of its USERDATA, into the next robot's variables; see docs/debugging.md.
#include "pogobase.h"

typedef struct {
    uint32_t steps;
    uint8_t heard[4];
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

void user_init(void) {}

void user_step(void) {
    mydata->steps++;
    mydata->heard[mydata->steps % 5] = 1;
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
