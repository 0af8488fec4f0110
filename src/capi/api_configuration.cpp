// simulation.h: values under `parameters` for a program's globals.
#include <algorithm>
#include <concepts>
#include <cstring>
#include <limits>
#include <mutex>
#include <string>

#include "process/crash_handler.hpp"
#include "process/program_image.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"

using pogosim::BoundVariable;
using pogosim::context;
using pogosim::ParameterSource;
using pogosim::require_argument;
using pogosim::require_robot;
using pogosim::without_exceptions;

namespace {

void check_call(char const* function, void const* variable, char const* name) {
    require_robot(function);
    require_argument(variable, function, "the variable");
    require_argument(name, function, "the name");
}

// How values of each type get into a variable. An absent value changes nothing.

void assign_bool(ParameterSource& source, std::string const& name, void* variable, std::size_t /*size*/) {
    if (auto const found = source.boolean(name)) {
        *static_cast<bool*>(variable) = *found;
    }
}

template <std::integral T>
void assign_integer(ParameterSource& source, std::string const& name, void* variable, std::size_t /*size*/) {
    if (auto const found = source.integer(name, std::numeric_limits<T>::min(), std::numeric_limits<T>::max())) {
        *static_cast<T*>(variable) = static_cast<T>(*found);
    }
}

template <std::floating_point T>
void assign_number(ParameterSource& source, std::string const& name, void* variable, std::size_t /*size*/) {
    if (auto const found = source.number(name, std::numeric_limits<T>::max())) {
        *static_cast<T*>(variable) = static_cast<T>(*found);
    }
}

template <std::floating_point T>
void assign_numbers(ParameterSource& source, std::string const& name, void* array, std::size_t size) {
    if (auto const found = source.numbers(name, size, std::numeric_limits<T>::max())) {
        std::transform(found->begin(), found->end(), static_cast<T*>(array),
                       [](double value) { return static_cast<T>(value); });
    }
}

void assign_text(ParameterSource& source, std::string const& name, void* text, std::size_t size) {
    auto const found = source.text(name, size > 0 ? size - 1 : 0);
    if (found && size > 0) {
        std::memcpy(text, found->c_str(), found->size() + 1);
    }
}

/// Variables on the stack are left out: only what lives as long as the run can be set later.
bool is_in_program(void const* variable) {
    return pogosim::is_in_any(context.services->program_variables, variable) ||
           pogosim::is_in_any({&context.services->user_data, 1}, variable);
}

/// Where parts of the swarm run on several threads, a variable that all robots share has had its value since before the
/// first step. Setting it again, with the default in between, would be visible to other threads.
bool is_set_for_all(void const* variable) {
    return context.outbox != nullptr && pogosim::is_in_any(context.services->program_variables, variable);
}

void bind(BoundVariable const& bound) {
    // An invalid pointer of the program crashes here, before the lock is taken.
    auto* const bytes = static_cast<unsigned char volatile*>(bound.variable);
    if (bound.bytes > 0) {
        bytes[0] = bytes[0];
        bytes[bound.bytes - 1] = bytes[bound.bytes - 1];
    }
    std::lock_guard const lock(context.services->parameters_mutex);
    bound.read(*context.services->parameters, bound.name, bound.variable, bound.size);
    auto& all = context.services->bound_variables;
    auto const is_same = [&](BoundVariable const& known) {
        return known.variable == bound.variable && known.name == bound.name;
    };
    if (is_in_program(bound.variable) && std::ranges::none_of(all, is_same)) {
        all.push_back(bound);
    }
}

template <class T>
void read_value(char const* function, decltype(BoundVariable::read) read, T* variable, char const* name,
                T default_value) {
    check_call(function, variable, name);
    if (is_set_for_all(variable)) {
        return;
    }
    without_exceptions([&] {
        *variable = default_value;
        bind({.name = name, .read = read, .variable = variable, .bytes = sizeof(T)});
    });
}

template <class T>
void read_several(char const* function, decltype(BoundVariable::read) read, T* array, char const* name,
                  std::size_t size) {
    check_call(function, array, name);
    if (is_set_for_all(array)) {
        return;
    }
    without_exceptions(
        [&] { bind({.name = name, .read = read, .variable = array, .size = size, .bytes = size * sizeof(T)}); });
}

}  // namespace

void init_bool_from_configuration(bool* variable, char const* name, bool const default_value) {
    read_value(__func__, assign_bool, variable, name, default_value);
}

void init_float_from_configuration(float* variable, char const* name, float const default_value) {
    read_value(__func__, assign_number<float>, variable, name, default_value);
}
void init_double_from_configuration(double* variable, char const* name, double const default_value) {
    read_value(__func__, assign_number<double>, variable, name, default_value);
}
void init_int32_from_configuration(int32_t* variable, char const* name, int32_t const default_value) {
    read_value(__func__, assign_integer<int32_t>, variable, name, default_value);
}
void init_uint32_from_configuration(uint32_t* variable, char const* name, uint32_t const default_value) {
    read_value(__func__, assign_integer<uint32_t>, variable, name, default_value);
}
void init_int16_from_configuration(int16_t* variable, char const* name, int16_t const default_value) {
    read_value(__func__, assign_integer<int16_t>, variable, name, default_value);
}
void init_uint16_from_configuration(uint16_t* variable, char const* name, uint16_t const default_value) {
    read_value(__func__, assign_integer<uint16_t>, variable, name, default_value);
}
void init_int8_from_configuration(int8_t* variable, char const* name, int8_t const default_value) {
    read_value(__func__, assign_integer<int8_t>, variable, name, default_value);
}
void init_uint8_from_configuration(uint8_t* variable, char const* name, uint8_t const default_value) {
    read_value(__func__, assign_integer<uint8_t>, variable, name, default_value);
}

void init_float_array_from_configuration(float* array, char const* name, size_t const size) {
    read_several(__func__, assign_numbers<float>, array, name, size);
}
void init_double_array_from_configuration(double* array, char const* name, size_t const size) {
    read_several(__func__, assign_numbers<double>, array, name, size);
}

void init_string_from_configuration(char* text, char const* name, size_t const size) {
    read_several(__func__, assign_text, text, name, size);
}

void refuse_parameter(char const* name, char const* expected) {
    require_robot(__func__);
    require_argument(name, __func__, "the name");
    require_argument(expected, __func__, "the text of what was expected");
    without_exceptions([&] {
        std::lock_guard const lock(context.services->parameters_mutex);
        context.services->parameters->refuse(name, expected);
    });
}

void check_parameter_range(char const* name, double value, double min, double max) {
    require_robot(__func__);
    require_argument(name, __func__, "the name");
    without_exceptions([&] {
        std::lock_guard const lock(context.services->parameters_mutex);
        context.services->parameters->check_range(name, value, min, max);
    });
}
