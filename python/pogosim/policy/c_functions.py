"""The functions of an exported policy that do not depend on its size, as templates of C.

`@` stands for the prefix of all names, and `@value_t` for the type of inputs and outputs. Each is emitted if the policy
needs it, after those that it calls.
"""

from __future__ import annotations

from pogosim.policy.c_text import literal
from pogosim.policy.float_arithmetic import LOG2_E, POWER_OF_TWO

ADD_PRODUCT = """// Adds weights, of so many rows and columns, times values to the sums.
static inline void @add_product(
    @weight_t const* weights, @number_t const* values, uint16_t rows, uint16_t columns, @sum_t* sums) {
    for (uint16_t row = 0; row < rows; row++) {
        @sum_t sum = sums[row];
        for (uint16_t column = 0; column < columns; column++) {
            sum += weights[column] * values[column];
        }
        sums[row] = sum;
        weights += columns;
    }
}
"""

HORNER = "\n".join(
    f"    power = power * fraction + {literal(coefficient, 'float')};" for coefficient in POWER_OF_TWO[1:]
)

CUT = """static inline @value_t @cut(@value_t value, @value_t least, @value_t most) {
    return value < least ? least : value > most ? most : value;
}
"""

# ---- Floats. The exponential function is 2^whole times a polynomial of 2^fraction; no C library is needed.

OF_FLOATS = {
    "cut": CUT,
    "exp": f"""// exp(x) of numbers up to 0.
static inline float @exp_of_negative(float x) {{
    union {{ uint32_t bits; float value; }} two_to_whole;
    float const y = (x > -87.0f ? x : -87.0f) * {literal(LOG2_E, "float")};
    int32_t const whole = (int32_t)(y - 0.5f);
    float const fraction = y - (float)whole;
    float power = {literal(POWER_OF_TWO[0], "float")};
{HORNER}
    two_to_whole.bits = (uint32_t)(whole + 127) << 23;
    return power * two_to_whole.value;
}}
""",
    "tanh": """static inline float @tanh(float x) {
    float const e = @exp_of_negative(-2.0f * (x < 0.0f ? -x : x));
    float const size = (1.0f - e) / (1.0f + e);
    return x < 0.0f ? -size : size;
}
""",
    "sigmoid": """static inline float @sigmoid(float x) {
    float const e = @exp_of_negative(x < 0.0f ? x : -x);
    float const share = 1.0f / (1.0f + e);
    return x < 0.0f ? e * share : share;
}
""",
    "relu": """static inline float @relu(float x) {
    return x > 0.0f ? x : 0.0f;
}
""",
    "hardtanh": """static inline float @hardtanh(float x) {
    return x < -1.0f ? -1.0f : x > 1.0f ? 1.0f : x;
}
""",
    "identity": """static inline float @identity(float x) {
    return x;
}
""",
    "gru": """// The next state of a GRU with so many units, of the sums for reset, keep, new and old values.
static inline void @next_gru(float const* sums, uint16_t units, float* state) {
    for (uint16_t i = 0; i < units; i++) {
        float const reset = @sigmoid(sums[i]);
        float const keep = @sigmoid(sums[units + i]);
        float const candidate = @tanh(sums[2 * units + i] + reset * sums[3 * units + i]);
        state[i] = candidate + keep * (state[i] - candidate);
    }
}
""",
}
OF_FLOAT_LAYER = """static inline void @next_{activation}(float const* sums, uint16_t units, float* values) {{
    for (uint16_t i = 0; i < units; i++) {{
        values[i] = @{activation}(sums[i]);
    }}
}}
"""

# ---- Whole numbers

OF_INTEGERS = {
    "cut": CUT,
    "shifted": """// value / 2^shift, rounded down; C leaves the shift of negative numbers to the compiler.
static inline int32_t @shifted(int32_t value, int shift) {
    return value < 0 ? ~(~value >> shift) : value >> shift;
}
""",
    "scaled": """// sum / 2^shift, rounded, and cut to a size; sums are at most 2^30 - 1.
static inline int32_t @scaled(int32_t sum, int shift, int32_t most) {
    if (shift < 0) {
        int32_t const cut = most >> -shift;
        return @cut(sum, -cut, cut) * ((int32_t)1 << -shift);
    }
    return @cut(@shifted(sum + (((int32_t)1 << shift) >> 1), shift), -most, most);
}
""",
    "tanh": """// tanh of a number with 12 fraction bits, with 14.
static inline int16_t @tanh(int32_t argument) {
    int32_t const size = argument < 0 ? -argument : argument;
    int32_t const below = @tanh_table[size >> 7];
    int32_t const found = below + (((@tanh_table[(size >> 7) + 1] - below) * (size & 127) + 64) >> 7);
    return (int16_t)(argument < 0 ? -found : found);
}
""",
    "sigmoid": """// The sigmoid of a number with 11 fraction bits, with 14.
static inline int16_t @sigmoid(int32_t argument) {
    return (int16_t)((16385 + @tanh(argument)) >> 1);
}
""",
    "relu": """static inline int16_t @relu(int32_t value) {
    return (int16_t)(value > 0 ? value : 0);
}
""",
    "identity": """static inline int16_t @identity(int32_t value) {
    return (int16_t)value;
}
""",
    "gru": """// The next state of a GRU with so many units, of the sums for reset, keep, new and old values; new_shift
// is that of the last two together.
static inline void @next_gru(
    int32_t const* sums, int8_t const* shift, uint16_t units, int new_shift, int16_t* state) {
    for (uint16_t i = 0; i < units; i++) {
        int32_t const reset = @sigmoid(@scaled(sums[i], shift[i], 32767));
        int32_t const keep = @sigmoid(@scaled(sums[units + i], shift[units + i], 32767));
        int32_t const fresh = @scaled(sums[2 * units + i], shift[2 * units + i], 32767);
        int32_t const old = @scaled(sums[3 * units + i], shift[3 * units + i], 32767);
        int32_t const both = fresh + @shifted(reset * old + 8192, 14);
        int32_t const candidate = @tanh(@scaled(both, new_shift, 32767));
        state[i] = (int16_t)(candidate + @shifted(keep * (state[i] - candidate) + 8192, 14));
    }
}
""",
    "outputs": """// The outputs, of sums that have their scale.
static inline void @next_outputs(
    int32_t const* sums, int8_t const* shift, uint16_t units, int32_t* outputs) {
    for (uint16_t i = 0; i < units; i++) {
        outputs[i] = @scaled(sums[i], shift[i], 1073741823);
    }
}
""",
}
OF_INTEGER_LAYER = """static inline void @next_{activation}(
    int32_t const* sums, int8_t const* shift, uint16_t units, int16_t* values) {{
    for (uint16_t i = 0; i < units; i++) {{
        values[i] = @{function}(@scaled(sums[i], shift[i], {most}));
    }}
}}
"""

# What each function calls, so that it is emitted before it.
CALLS = {
    "tanh": ("exp", "scaled"),
    "sigmoid": ("exp", "tanh", "scaled"),
    "gru": ("sigmoid", "tanh"),
    "relu": ("scaled",),
    "identity": ("scaled",),
    "hardtanh": ("identity", "scaled"),
    "outputs": ("scaled",),
    "scaled": ("cut", "shifted"),
}


def needed(names: set[str], parts: dict[str, str]) -> list[str]:
    """Return these parts and those that they call, in the order of the table."""
    found: set[str] = set()
    left = list(names)
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            left += CALLS.get(name, ())
    return [text for name, text in parts.items() if name in found]
