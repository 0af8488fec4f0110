"""The functions of an exported policy that do not depend on its size, as templates of C, by their names.

`@` stands for the prefix of all names, `$` for that of numbers of the arithmetic, and `@value_t`, `@weight_t`,
`@number_t` and `@sum_t` for the types of inputs and outputs, weights, values between layers, and sums. Functions stand
behind those that they call.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from string import Template

from pogosim.policy.c_text import literal
from pogosim.policy.choices import ACTIVATIONS
from pogosim.policy.fixed_arithmetic import FUNCTIONS, MOST_VALUE, OUTPUTS
from pogosim.policy.float_arithmetic import LEAST_EXPONENT, LOG2_E, POWER_OF_TWO
from pogosim.policy.tanh_table import ARGUMENT_BITS, INDEX_BITS, ONE, VALUE_BITS

CALL = re.compile(r"@(\w+)\(")

CUT = """static inline @value_t @cut(@value_t value, @value_t least, @value_t most) {
    return value < least ? least : value > most ? most : value;
}
"""
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

# ---- Floats. The exponential function is 2^whole times a polynomial of 2^fraction; no C library is needed.

HORNER = "\n".join(
    f"    power = power * fraction + {literal(coefficient, 'float')};" for coefficient in POWER_OF_TWO[1:]
)
EXP = Template("""// exp(x) of numbers up to 0.
static inline float @exp_of_negative(float x) {
    union { uint32_t bits; float value; } two_to_whole;
    float const y = (x > $least ? x : $least) * $log2_e;
    int32_t const whole = (int32_t)(y - 0.5f);
    float const fraction = y - (float)whole;
    float power = $first;
$horner
    two_to_whole.bits = (uint32_t)(whole + 127) << 23;
    return power * two_to_whole.value;
}
""").substitute(
    least=literal(LEAST_EXPONENT, "float"),
    log2_e=literal(LOG2_E, "float"),
    first=literal(POWER_OF_TWO[0], "float"),
    horner=HORNER,
)
OF_FLOATS = {
    "cut": CUT,
    "exp_of_negative": EXP,
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
    "next_gru": """// The next state of a GRU with so many units, of the sums for reset, keep, new and old values.
static inline void @next_gru(float const* sums, uint16_t units, float* state) {
    float const* const fresh = sums + units + units;
    float const* const old = fresh + units;
    for (uint16_t i = 0; i < units; i++) {
        float const reset = @sigmoid(sums[i]);
        float const keep = @sigmoid(sums[units + i]);
        float const candidate = @tanh(fresh[i] + reset * old[i]);
        state[i] = candidate + keep * (state[i] - candidate);
    }
}
""",
    "add_product": ADD_PRODUCT,
}
OF_FLOATS |= {
    f"next_{name}": f"""static inline void @next_{name}(float const* sums, uint16_t units, float* values) {{
    for (uint16_t i = 0; i < units; i++) {{
        values[i] = @{name}(sums[i]);
    }}
}}
"""
    for name in ACTIVATIONS
}

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
    "tanh": """// tanh of a number with $argument_bits fraction bits, with $value_bits.
static inline int16_t @tanh(int32_t argument) {
    int32_t const size = argument < 0 ? -argument : argument;
    int32_t const below = @tanh_table[size >> $index_bits];
    int32_t const above = @tanh_table[(size >> $index_bits) + 1];
    int32_t const found = below + (((above - below) * (size & $index_mask) + $index_half) >> $index_bits);
    return (int16_t)(argument < 0 ? -found : found);
}
""",
    "sigmoid": """// The sigmoid of a number with one fraction bit less, with $value_bits.
static inline int16_t @sigmoid(int32_t argument) {
    return (int16_t)(($one + 1 + @tanh(argument)) >> 1);
}
""",
    "relu": """static inline int16_t @relu(int32_t value) {
    return (int16_t)(value > 0 ? value : 0);
}
""",
    "next_gru": """// The next state of a GRU with so many units, of the sums for reset, keep, new and old values;
// new_shift is that of the last two together.
static inline void @next_gru(
    int32_t const* sums, int8_t const* shift, uint16_t units, int new_shift, int16_t* state) {
    int const new_sums = units + units;
    int const old_sums = new_sums + units;
    for (uint16_t i = 0; i < units; i++) {
        int32_t const reset = @sigmoid(@scaled(sums[i], shift[i], $most_value));
        int32_t const keep = @sigmoid(@scaled(sums[units + i], shift[units + i], $most_value));
        int32_t const fresh = @scaled(sums[new_sums + i], shift[new_sums + i], $most_value);
        int32_t const old = @scaled(sums[old_sums + i], shift[old_sums + i], $most_value);
        int32_t const both = fresh + @shifted(reset * old + $half, $value_bits);
        int32_t const candidate = @tanh(@scaled(both, new_shift, $most_value));
        state[i] = (int16_t)(candidate + @shifted(keep * (state[i] - candidate) + $half, $value_bits));
    }
}
""",
    "add_product": ADD_PRODUCT,
}
# How values are made of arguments, and their type where it is not int16_t.
CALLS = dict.fromkeys(FUNCTIONS, "(int16_t)") | {name: f"@{name}" for name in FUNCTIONS if name in OF_INTEGERS}
CALLS[OUTPUTS] = ""
TYPES = {OUTPUTS: "int32_t"}
OF_INTEGERS |= {
    f"next_{name}": f"""static inline void @next_{name}(
    int32_t const* sums, int8_t const* shift, uint16_t units, {TYPES.get(name, "int16_t")}* values) {{
    for (uint16_t i = 0; i < units; i++) {{
        values[i] = {CALLS[name]}(@scaled(sums[i], shift[i], {function.most}));
    }}
}}
"""
    for name, function in FUNCTIONS.items()
}
CONSTANTS = {
    "argument_bits": ARGUMENT_BITS,
    "value_bits": VALUE_BITS,
    "one": ONE,
    "half": ONE // 2,
    "most_value": MOST_VALUE,
    "index_bits": INDEX_BITS,
    "index_mask": (1 << INDEX_BITS) - 1,
    "index_half": 1 << (INDEX_BITS - 1),
}
OF_INTEGERS = {name: Template(text).substitute(CONSTANTS) for name, text in OF_INTEGERS.items()}


def needed(text: str, functions: Mapping[str, str]) -> list[str]:
    """Return the functions that a text calls, and those that they call, in the order of the table."""
    found: set[str] = set()
    left = [text]
    while left:
        called = {name for name in CALL.findall(left.pop()) if name in functions} - found
        found |= called
        left += [functions[name] for name in called]
    return [text for name, text in functions.items() if name in found]


def multiplications_in(text: str, functions: Mapping[str, str]) -> int:
    """Return how often a text multiplies at most, if each loop in the functions that it calls runs once."""
    calls = [name for name in CALL.findall(text) if name in functions]
    return text.count(" * ") + sum(multiplications_of(name, functions) for name in calls)


def multiplications_of(name: str, functions: Mapping[str, str]) -> int:
    """Return how often a function multiplies at most, if each of its loops runs once."""
    own = functions[name].split("{", 1)[1]
    return multiplications_in(own, functions)
