// Values that functions of Pogolib cannot take as they are, for warnings. The headers say what happens to such values.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace pogosim {

/// All are literals.
struct Slip {
    std::string_view function;  // "pogobot_motor_set"; empty: a variable of the main loop
    std::string_view argument;  // "value", or the variable
    std::string_view expected;  // "0 to 1023 (motorFull)"
    std::string_view outcome;   // "1023 is used"
};

/// The same without the function.
struct WrongArgument {
    std::string_view name;
    std::string_view expected;
    std::string_view outcome;
};

template <class Value>
std::string slip_text(Slip const& slip, Value const& value) {
    return fmt::format("{}{}{} is {}, expected {}; {}", slip.function,
                       slip.function.empty() ? "" : "(): ", slip.argument, value, slip.expected, slip.outcome);
}

}  // namespace pogosim
