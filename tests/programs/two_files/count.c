#include "userdata.h"

void count_up(void) {
    mydata->count += pogobot_helper_getid() + 1u;
}
