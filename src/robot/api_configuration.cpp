// simulation.h: values under `parameters` for a program's globals.
#include <algorithm>
#include <concepts>
#include <cstring>
#include <limits>

#include "robot/context.hpp"
#include "robot/require_robot.hpp"
#include "robot/user_guard.hpp"

using pogosim::context;
using pogosim::require_argument;
using pogosim::require_robot;
using pogosim::without_exceptions;

namespace {

void check_call(char const* function, void const* variable, char const* name) {
    require_robot(function);
    require_argument(variable, function, "the variable");
    require_argument(name, function, "the name");
}

template <std::integral T>
void read_integer(char const* function, T* variable, char const* name, T default_value) {
    check_call(function, variable, name);
    without_exceptions([&] {
        auto const found =
            context.services->parameters->integer(name, std::numeric_limits<T>::min(), std::numeric_limits<T>::max());
        *variable = found ? static_cast<T>(*found) : default_value;
    });
}

template <std::floating_point T>
void read_number(char const* function, T* variable, char const* name, T default_value) {
    check_call(function, variable, name);
    without_exceptions([&] {
        auto const found = context.services->parameters->number(name, std::numeric_limits<T>::max());
        *variable = found ? static_cast<T>(*found) : default_value;
    });
}

template <std::floating_point T>
void read_numbers(char const* function, T* array, char const* name, std::size_t size) {
    check_call(function, array, name);
    without_exceptions([&] {
        if (auto const found = context.services->parameters->numbers(name, size, std::numeric_limits<T>::max())) {
            std::transform(found->begin(), found->end(), array, [](double value) { return static_cast<T>(value); });
        }
    });
}

}  // namespace

void init_bool_from_configuration(bool* variable, char const* name, bool const default_value) {
    check_call(__func__, variable, name);
    without_exceptions([&] { *variable = context.services->parameters->boolean(name).value_or(default_value); });
}

void init_float_from_configuration(float* variable, char const* name, float const default_value) {
    read_number(__func__, variable, name, default_value);
}
void init_double_from_configuration(double* variable, char const* name, double const default_value) {
    read_number(__func__, variable, name, default_value);
}
void init_int32_from_configuration(int32_t* variable, char const* name, int32_t const default_value) {
    read_integer(__func__, variable, name, default_value);
}
void init_uint32_from_configuration(uint32_t* variable, char const* name, uint32_t const default_value) {
    read_integer(__func__, variable, name, default_value);
}
void init_int16_from_configuration(int16_t* variable, char const* name, int16_t const default_value) {
    read_integer(__func__, variable, name, default_value);
}
void init_uint16_from_configuration(uint16_t* variable, char const* name, uint16_t const default_value) {
    read_integer(__func__, variable, name, default_value);
}
void init_int8_from_configuration(int8_t* variable, char const* name, int8_t const default_value) {
    read_integer(__func__, variable, name, default_value);
}
void init_uint8_from_configuration(uint8_t* variable, char const* name, uint8_t const default_value) {
    read_integer(__func__, variable, name, default_value);
}

void init_float_array_from_configuration(float* array, char const* name, size_t const size) {
    read_numbers(__func__, array, name, size);
}
void init_double_array_from_configuration(double* array, char const* name, size_t const size) {
    read_numbers(__func__, array, name, size);
}

void init_string_from_configuration(char* text, char const* name, size_t const size) {
    check_call(__func__, text, name);
    without_exceptions([&] {
        auto const found = context.services->parameters->text(name);
        if (found && size > 0) {
            std::size_t const length = std::min(found->size(), size - 1);
            std::memcpy(text, found->data(), length);
            text[length] = '\0';
        }
    });
}

void refuse_parameter(char const* name, char const* expected) {
    require_robot(__func__);
    require_argument(name, __func__, "the name");
    require_argument(expected, __func__, "the text of what was expected");
    without_exceptions([&] { context.services->parameters->refuse(name, expected); });
}

void check_parameter_range(char const* name, double value, double min, double max) {
    require_robot(__func__);
    require_argument(name, __func__, "the name");
    without_exceptions([&] { context.services->parameters->check_range(name, value, min, max); });
}
