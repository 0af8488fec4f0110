// The smallest program: no user data, no step.
#include "pogobase.h"

static void greet(void) {
    printf("robot %u\n", pogobot_helper_getid());
}

int main(void) {
    pogobot_init();
    pogobot_start(greet, NULL);
    return 0;
}
