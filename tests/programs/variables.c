// Variables of every kind, for tests/robot/program_variables_test.cpp, which reads them as the window does.
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum { WALKING, TURNING = 7, LOST = -2 } state_t;

typedef struct {
    float x;
    double y;
} place_t;

typedef struct {
    uint8_t age;
    int16_t balance;
    bool is_happy;
    state_t state;
    place_t place;
    uint16_t history[12];
    int8_t table[2][3];
    char name[8];
    place_t corners[2];
    void* nothing;
    unsigned low : 3;
    int high : 5;
    union {
        uint32_t word;
        uint8_t bytes[4];
    } raw;
    struct {
        int64_t inner;
    };
} data_t;

__thread data_t* mydata;
__attribute__((used)) static data_t const* const pogo_user_data_type = 0;  // as REGISTER_USERDATA has it

data_t example = {.age = 200,
                  .balance = -300,
                  .is_happy = true,
                  .state = TURNING,
                  .place = {0.5F, -2.25},
                  .history = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12},
                  .table = {{-1, 2, -3}, {4, -5, 6}},
                  .name = "ab\n",
                  .corners = {{1, 2}, {3, 4}},
                  .nothing = NULL,
                  .low = 5,
                  .high = -7,
                  .raw = {.word = 0x01020304},
                  .inner = -9000000000};
size_t const size_of_data = sizeof(data_t);

uint32_t counter = 41;
static int twice = 1;
int const constant = 3;

int next(void) {
    static int twice = 10;
    return twice++;
}

int other(void) {
    return twice++ + constant;
}
