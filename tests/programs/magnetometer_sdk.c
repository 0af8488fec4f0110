// A program for the robots' SDK 2.7: reads the magnetometer for ever, and prints each reading.
#include "magnetometer.h"

_Static_assert(LIS2MDL_WHO_AM_I_VALUE == 0x40, "the identity of the chip");

int main(void) {
    pogobot_init();
    printf("check %u, init %u\n", magn_check(), magn_init());
    magn_begin();
    while (1) {
        int16_t x, y, z;
        if (magn_read_XYZ(&x, &y, &z, 10) == 0) {
            printf("read %d %d %d\n", x, y, z);
        }
        msleep(10);
    }
}
