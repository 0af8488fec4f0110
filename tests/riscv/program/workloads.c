// Work for a processor: compiled for the robot's and for this machine, both must get the same results.
#include "workloads.h"

#define COUNT 1024

static uint32_t next_random(uint32_t* state) {
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

// CRC-32 (IEEE 802.3), bit by bit, of the numbers 0 to count - 1.
static uint32_t crc(uint32_t count) {
    uint32_t value = 0xffffffffu;
    for (uint32_t i = 0; i < count; i++) {
        value ^= i & 0xffu;
        for (int bit = 0; bit < 8; bit++) {
            value = value >> 1 ^ (0xedb88320u & -(value & 1u));
        }
    }
    return ~value;
}

// Sorts numbers by Shell's method, count times, and mixes some of them into the result.
static uint32_t sort(uint32_t count) {
    static uint32_t numbers[COUNT];
    uint32_t state = 1, result = 0;
    for (uint32_t round = 0; round < count; round++) {
        for (int i = 0; i < COUNT; i++) {
            numbers[i] = next_random(&state);
        }
        for (int gap = COUNT / 2; gap > 0; gap /= 2) {
            for (int i = gap; i < COUNT; i++) {
                uint32_t const moved = numbers[i];
                int place = i;
                for (; place >= gap && numbers[place - gap] > moved; place -= gap) {
                    numbers[place] = numbers[place - gap];
                }
                numbers[place] = moved;
            }
        }
        for (int i = 1; i < COUNT; i++) {
            result += numbers[i - 1] <= numbers[i] ? numbers[i] * (uint32_t)i : 0;
        }
    }
    return result;
}

// Products and sums of floats, which the robot calculates without a floating-point unit.
static uint32_t floats(uint32_t count) {
    union {
        float number;
        uint32_t bits;
    } sum = {1.0f};
    volatile float factor = 1.0009765625f;  // volatile: nothing is calculated while it is compiled, or contracted
    for (uint32_t i = 0; i < count; i++) {
        volatile float product = sum.number * factor;
        sum.number = product > 1000.0f ? product / 999.5f : product + 0.001f * (float)(i % 7u);
    }
    return sum.bits;
}

// Doubles, 64-bit integers, and each width of load and store, with and without sign.
static uint32_t mixture(uint32_t count) {
    static int8_t bytes[64];
    static int16_t halves[64];
    static uint8_t unsigned_bytes[64];
    static uint16_t unsigned_halves[64];
    uint32_t state = 7;
    uint64_t sum = 0;
    double number = 0.5;
    for (int i = 0; i < 64; i++) {
        bytes[i] = (int8_t)next_random(&state);
        halves[i] = (int16_t)next_random(&state);
        unsigned_bytes[i] = (uint8_t)next_random(&state);
        unsigned_halves[i] = (uint16_t)next_random(&state);
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t const random = next_random(&state);
        uint32_t const at = random % 64u;
        bytes[at] = (int8_t)(random >> 3);
        halves[at] = (int16_t)(random >> 5);
        unsigned_bytes[at] = (uint8_t)(random >> 7);
        unsigned_halves[at] = (uint16_t)(random >> 9);
        uint32_t const other = random >> 26;
        int32_t const mixed = bytes[other] * halves[other] - unsigned_bytes[other] * (int32_t)unsigned_halves[other];
        sum = sum * 6364136223846793005u + (uint64_t)(int64_t)mixed;
        sum ^= sum / (random | 1u);
        sum += (uint64_t)((int64_t)sum % (int64_t)((random >> 20) | 1u));
        number = number * 3.75 * (1.0 - number);
        sum += (uint32_t)(number * 1e6);
    }
    return (uint32_t)(sum ^ sum >> 32);
}

uint32_t workload(uint32_t which, uint32_t count) {
    switch (which) {
        case kCrc:
            return crc(count);
        case kSort:
            return sort(count);
        case kFloats:
            return floats(count);
        default:
            return mixture(count);
    }
}
