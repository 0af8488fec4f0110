// The policy of phototaxis.npz as C for robots: 3 inputs, 6 tanh, 2 hardtanh; whole numbers; weights of 16 bits. Made
// by `pogosim export-policy` of Pogosim 0.11.0; change the policy, and export it again.
//
// In a program with this header behind pogobase.h:
//
//     void user_init(void) {
//         if (!policy_self_test()) { pogobot_led_setColor(255, 0, 0); }  // not what was exported
//     }
//     void user_step(void) {
//         policy_value_t const inputs[POLICY_INPUTS] = {light, ahead, right};
//         policy_value_t outputs[POLICY_OUTPUTS];
//         policy_step(inputs, outputs);
//         ... outputs[POLICY_OUTPUT_MOTOR_RIGHT] ...
//     }
//
// Inputs and outputs are whole numbers. No sum or product leaves its type, whatever the inputs are. Their scales are at
// their names, below.
#ifndef POLICY_H
#define POLICY_H 0x004d2ee9
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

// clang-format off
// Inputs, in this order:
enum {
    POLICY_INPUT_LIGHT,  // light: scaled by (light - 15000) * 6.66667e-05, cut to 5101 to 29253
    POLICY_INPUT_AHEAD,  // ahead: scaled by (ahead - 0) * 0.001, cut to -1843 to 1881
    POLICY_INPUT_RIGHT,  // right: scaled by (right - 0) * 0.001, cut to -1396 to 1417
    POLICY_INPUTS
};
// Outputs:
enum {
    POLICY_OUTPUT_MOTOR_RIGHT,  // motor_right: value * 1023 + 0, within 2.32 of exact arithmetic
    POLICY_OUTPUT_MOTOR_LEFT,   // motor_left: value * 1023 + 0, within 3.54 of exact arithmetic
    POLICY_OUTPUTS
};

#define POLICY_CONSTANT_BYTES 763  // weights, biases, tables and test vector
#define POLICY_STATE_BYTES 0  // of each robot, in USERDATA
#define POLICY_STACK_BYTES 46  // arrays of a step
#define POLICY_MULTIPLICATIONS 49  // of a step, at most

typedef int32_t policy_value_t;  // of inputs and outputs

// ---- Constants

// Inputs are cut to this range.
static int32_t const policy_input_low[3] = {
    5101, -1843, -1396,
};
static int32_t const policy_input_high[3] = {
    29253, 1881, 1417,
};
static int32_t const policy_input_factor[3] = {
    35791, 268435, 268435,
};
static int32_t const policy_input_addend[3] = {
    -354282630, -494718377, -374727722,
};
static uint8_t const policy_input_shift[3] = {
    15, 14, 14,
};
// Layer 0: 6 rows of 3
static int16_t const policy_weights_0[18] = {
    -11978, -1383, 10544, -20914, -10465, -1082, -518, -15156, -8701, 19664, 2366, -3053, -4029, -17549, -12439, -30849,
    11130, 6719,
};
static int32_t const policy_bias_0[6] = {
    -86265600, 87928840, 72154312, -102658128, 37424812, -33819996,
};
static int8_t const policy_shift_0[6] = {
    15, 16, 15, 16, 15, 16,
};
// Layer 1: 2 rows of 6
static int16_t const policy_weights_1[12] = {
    -10018, 527, -3310, 2577, 6976, 2440, 11367, -13894, -11940, 343, -5321, 7091,
};
static int32_t const policy_bias_1[2] = {
    218297648, -35386472,
};
static int8_t const policy_shift_1[2] = {
    13, 13,
};
static int32_t const policy_output_factor[2] = {
    65472, 65472,
};
static int32_t const policy_output_addend[2] = {
    524288, 524288,
};
static uint8_t const policy_output_shift[2] = {
    20, 20,
};
// tanh from 0 to 8, times 16384
static int16_t const policy_tanh_table[257] = {
    0, 512, 1023, 1532, 2037, 2539, 3036, 3528, 4013, 4490, 4960, 5420, 5871, 6312, 6743, 7163, 7571, 7968, 8353, 8726,
    9087, 9435, 9771, 10095, 10406, 10706, 10993, 11269, 11533, 11785, 12027, 12258, 12478, 12688, 12888, 13078, 13260,
    13432, 13595, 13751, 13898, 14038, 14171, 14296, 14415, 14528, 14634, 14735, 14830, 14920, 15005, 15085, 15161,
    15232, 15300, 15363, 15423, 15480, 15533, 15584, 15631, 15676, 15718, 15757, 15795, 15830, 15863, 15894, 15923,
    15951, 15977, 16001, 16024, 16046, 16066, 16085, 16103, 16120, 16136, 16151, 16165, 16178, 16190, 16202, 16213,
    16223, 16233, 16242, 16251, 16259, 16266, 16273, 16280, 16286, 16292, 16298, 16303, 16308, 16312, 16317, 16321,
    16325, 16328, 16332, 16335, 16338, 16341, 16343, 16346, 16348, 16350, 16352, 16354, 16356, 16358, 16359, 16361,
    16362, 16363, 16365, 16366, 16367, 16368, 16369, 16370, 16371, 16372, 16372, 16373, 16374, 16374, 16375, 16375,
    16376, 16376, 16377, 16377, 16378, 16378, 16378, 16379, 16379, 16379, 16380, 16380, 16380, 16380, 16381, 16381,
    16381, 16381, 16381, 16382, 16382, 16382, 16382, 16382, 16382, 16382, 16382, 16383, 16383, 16383, 16383, 16383,
    16383, 16383, 16383, 16383, 16383, 16383, 16383, 16383, 16383, 16383, 16383, 16383, 16383, 16384, 16384, 16384,
    16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384,
    16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384,
    16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384,
    16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384,
    16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384, 16384,
};
// The test vector: inputs of steps from the initial state on
static int32_t const policy_test_inputs[4][3] = {
    {27241, 1417, -958},
    {26733, 1053, -910},
    {7261, 1245, -602},
    {24900, 350, 1417},
};
static int32_t const policy_test_outputs[4][2] = {
    {1023, 1023},
    {1023, 263},
    {1023, 853},
    {852, 1023},
};

// ---- Functions of policy_step() alone

static inline policy_value_t policy_cut(policy_value_t value, policy_value_t least, policy_value_t most) {
    return value < least ? least : value > most ? most : value;
}

// value / 2^shift, rounded down; C leaves the shift of negative numbers to the compiler.
static inline int32_t policy_shifted(int32_t value, int shift) {
    return value < 0 ? ~(~value >> shift) : value >> shift;
}

// sum / 2^shift, rounded, and cut to a size; sums are at most 2^30 - 1.
static inline int32_t policy_scaled(int32_t sum, int shift, int32_t most) {
    if (shift < 0) {
        int32_t const cut = most >> -shift;
        return policy_cut(sum, -cut, cut) * ((int32_t)1 << -shift);
    }
    return policy_cut(policy_shifted(sum + (((int32_t)1 << shift) >> 1), shift), -most, most);
}

// tanh of a number with 12 fraction bits, with 14.
static inline int16_t policy_tanh(int32_t argument) {
    int32_t const size = argument < 0 ? -argument : argument;
    int32_t const below = policy_tanh_table[size >> 7];
    int32_t const above = policy_tanh_table[(size >> 7) + 1];
    int32_t const found = below + (((above - below) * (size & 127) + 64) >> 7);
    return (int16_t)(argument < 0 ? -found : found);
}

// Adds weights, of so many rows and columns, times values to the sums.
static inline void policy_add_product(
    int16_t const* weights, int16_t const* values, uint16_t rows, uint16_t columns, int32_t* sums) {
    for (uint16_t row = 0; row < rows; row++) {
        int32_t sum = sums[row];
        for (uint16_t column = 0; column < columns; column++) {
            sum += weights[column] * values[column];
        }
        sums[row] = sum;
        weights += columns;
    }
}

static inline void policy_next_hardtanh(
    int32_t const* sums, int8_t const* shift, uint16_t units, int16_t* values) {
    for (uint16_t i = 0; i < units; i++) {
        values[i] = (int16_t)(policy_scaled(sums[i], shift[i], 16384));
    }
}

static inline void policy_next_tanh(
    int32_t const* sums, int8_t const* shift, uint16_t units, int16_t* values) {
    for (uint16_t i = 0; i < units; i++) {
        values[i] = policy_tanh(policy_scaled(sums[i], shift[i], 32767));
    }
}

// ---- Functions for programs

// Computes the outputs for these inputs.
static inline void policy_step(policy_value_t const inputs[], policy_value_t outputs[]) {
    int16_t scaled[3];
    int16_t layer_0[6];
    int16_t layer_1[2];
    int32_t sums[6];
    for (uint16_t i = 0; i < 3; i++) {
        int32_t const above = policy_cut(inputs[i], policy_input_low[i], policy_input_high[i]) - policy_input_low[i];
        int32_t const sum = above * policy_input_factor[i] + policy_input_addend[i];
        scaled[i] = (int16_t)policy_shifted(sum, policy_input_shift[i]);
    }
    // Layer 0: 6 tanh
    memcpy(sums, policy_bias_0, sizeof(policy_bias_0));
    policy_add_product(policy_weights_0, scaled, 6, 3, sums);
    policy_next_tanh(sums, policy_shift_0, 6, layer_0);
    // Layer 1: 2 hardtanh
    memcpy(sums, policy_bias_1, sizeof(policy_bias_1));
    policy_add_product(policy_weights_1, layer_0, 2, 6, sums);
    policy_next_hardtanh(sums, policy_shift_1, 2, layer_1);
    for (uint16_t i = 0; i < 2; i++) {
        int32_t const sum = layer_1[i] * policy_output_factor[i] + policy_output_addend[i];
        outputs[i] = policy_shifted(sum, policy_output_shift[i]);
    }
}

// Whether this program and this processor give the outputs that were there when the policy was exported.
static inline bool policy_self_test(void) {
    policy_value_t outputs[POLICY_OUTPUTS];
    for (uint16_t step = 0; step < 4; step++) {
        policy_step(policy_test_inputs[step], outputs);
        for (uint16_t i = 0; i < 2; i++) {
            if (outputs[i] != policy_test_outputs[step][i]) {
                return false;
            }
        }
    }
    return true;
}
// clang-format on
#elif POLICY_H != 0x004d2ee9
#error "another policy named policy is included: export one of them with another --name"
#endif
