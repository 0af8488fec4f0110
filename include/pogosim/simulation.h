/// @file
/// Simulator-only functions: configuration values for a program's globals, columns of the data file, callbacks.
/// Real robots have only an empty SET_CALLBACK(): use everything else inside `#ifdef SIMULATOR`.
/// Errors end the run with a message and exit code 2.
#ifndef POGOSIM_SIMULATION_H
#define POGOSIM_SIMULATION_H

#include "pogosim/pogolib.h"
#include "pogosim/shared_state.h"

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

// ---- The run ----

/// Number of objects that run code: robots, pogobjects, active objects, walls and membranes.
/// @range returns 0 or more
uint32_t get_nb_robots(void);
/// Ends the run after the current time step, with a complete data file and exit code 0.
void stop_simulation(void);

// ---- Callbacks: SET_CALLBACK(callback_name, function), in main() after pogobot_start() ----

/// Sets a callback; in main(), after pogobot_start() or, with pogobot.h, before the first wait. On real robots it does
/// nothing, and the function need not exist.
#define SET_CALLBACK(callback_name, fn) ((callback_name) = (fn))

/// Once, before any user_init: read the configuration here. With pogobot.h, when all robots have come to their first
/// wait.
extern POGO_PER_ROBOT void (*callback_global_setup)(void);
/// Once, after every user_init, if there is a data file: declare columns here.
extern POGO_PER_ROBOT void (*callback_create_data_schema)(void);
/// For each object at time 0 and at each save period: set the values of its row.
extern POGO_PER_ROBOT void (*callback_export_data)(void);
/// Every 16 ms of simulated time, before the robots, in its own context (category "__system", no body).
extern POGO_PER_ROBOT void (*callback_global_step)(void);
/// For each object at the end of the run.
extern POGO_PER_ROBOT void (*callback_robot_end)(void);
/// For the robot that is clicked in the window, between two steps of the simulation. The data file's metadata then say
/// that the run was touched.
extern POGO_PER_ROBOT void (*callback_robot_click)(void);

// ---- Configuration: values under `parameters:` ----

///@{
/// Sets the variable to the value of `parameters.NAME` (dots address entries of maps and lists), or to the default if
/// it is absent or, with a warning, of another type (--strict: an error). A value outside the range of the variable's
/// type is an error; for integers, fractions are truncated, with a warning.
/// @range the range of the type
void init_bool_from_configuration(bool* variable, char const* name, bool const default_value);
void init_float_from_configuration(float* variable, char const* name, float const default_value);
void init_double_from_configuration(double* variable, char const* name, double const default_value);
void init_int32_from_configuration(int32_t* variable, char const* name, int32_t const default_value);
void init_uint32_from_configuration(uint32_t* variable, char const* name, uint32_t const default_value);
void init_int16_from_configuration(int16_t* variable, char const* name, int16_t const default_value);
void init_uint16_from_configuration(uint16_t* variable, char const* name, uint16_t const default_value);
void init_int8_from_configuration(int8_t* variable, char const* name, int8_t const default_value);
void init_uint8_from_configuration(uint8_t* variable, char const* name, uint8_t const default_value);
///@}

///@{
/// Sets an array to the first `size` numbers of the list `parameters.NAME`, with a warning if there are more. An absent
/// or empty list changes nothing; a shorter one is an error.
/// @range size: numbers
void init_float_array_from_configuration(float* array, char const* name, size_t const size);
void init_double_array_from_configuration(double* array, char const* name, size_t const size);
///@}
/// Sets a string (an array of `size` characters) to `parameters.NAME`, truncated to `size` - 1 characters,
/// with a warning; an absent one changes nothing.
/// @range size: bytes, with the final 0
void init_string_from_configuration(char* text, char const* name, size_t const size);

/// Rejects the value of `parameters.NAME`: ends the run with exit code 2 and a message that gives its line, what was
/// `expected` and what was found.
void refuse_parameter(char const* name, char const* expected);
/// Does the same unless `value`, which was read from `parameters.NAME`, is from `min` to `max` (NaN never is).
/// @range value: min to max
void check_parameter_range(char const* name, double value, double min, double max);
/// Ends the run with a message, like refuse_parameter(), unless a variable set by init_from_configuration() is a number
/// from `min` to `max`: `check_parameter(heartbeat_hz, 1, 1000)`.
/// @range variable: min to max
#define check_parameter(variable, min, max) check_parameter_range(#variable, (double)(variable), (min), (max))

// ---- Data file ----

///@{
/// Adds a column to the data file; only in callback_create_data_schema. A second column of the same name is an error.
void data_add_column_int8(char const* name);
void data_add_column_int16(char const* name);
void data_add_column_int32(char const* name);
void data_add_column_int64(char const* name);
void data_add_column_float(char const* name);
void data_add_column_double(char const* name);
void data_add_column_string(char const* name);
void data_add_column_bool(char const* name);
void data_add_column_float16(char const* name);
///@}

///@{
/// Sets the value of a column in this object's row; only in callback_export_data. Elsewhere, it does nothing, with a
/// warning. A column that is not set is null, and so is a NULL string. An unknown column, or a type other than
/// declared, is an error; columns omitted from `data_logger_fields` are ignored. float has 24 significant bits, float16
/// has 11 and is at most 65504. Integers beyond the range of the type wrap around, with a warning (without one for an
/// unsigned int in a column of 32 bits, as -8 is one).
/// @range the range of the type
void data_set_value_int8(char const* name, int8_t value);
void data_set_value_int16(char const* name, int16_t value);
void data_set_value_int32(char const* name, int32_t value);
void data_set_value_int64(char const* name, int64_t value);
void data_set_value_float(char const* name, float value);
void data_set_value_double(char const* name, double value);
void data_set_value_string(char const* name, char const* value);
void data_set_value_bool(char const* name, bool value);
void data_set_value_float16(char const* name, float value);
///@}

// The value of a column of integers, as these functions take it. One beyond the range is told here: as an argument of
// data_set_value_int8(), it would already have been wrapped. An unsigned int for a column of 32 bits is not: a
// difference of two, such as -8, is far beyond the range until it is wrapped.
int8_t pogosim_int8_value(int64_t value);
int16_t pogosim_int16_value(int64_t value);
int32_t pogosim_int32_value(int64_t value);
int32_t pogosim_int32_of_unsigned(unsigned int value);
#ifndef POGOSIM_INSIDE
// Each begins with the name of its function, so that a member of this name can be called, too. (Inside a macro, its own
// name is the function's.)
#define data_set_value_int8(name, ...) data_set_value_int8(name, pogosim_int8_value((__VA_ARGS__)))
#define data_set_value_int16(name, ...) data_set_value_int16(name, pogosim_int16_value((__VA_ARGS__)))
#ifdef __cplusplus
extern "C++" {
template <class T>
struct PogosimIfUnsignedInt {};
template <>
struct PogosimIfUnsignedInt<unsigned int> {
    using Column = int32_t;
};
template <class T>
POGO_INLINE typename PogosimIfUnsignedInt<T>::Column pogosim_int32_value(T value) {
    return pogosim_int32_of_unsigned(value);
}
}
#define data_set_value_int32(name, ...) data_set_value_int32(name, pogosim_int32_value((__VA_ARGS__)))
#else
// clang-format off
#define data_set_value_int32(name, ...)                                                                               \
    data_set_value_int32(name, __extension__ _Generic((__VA_ARGS__), unsigned int: pogosim_int32_of_unsigned,         \
                                                      default: pogosim_int32_value)((__VA_ARGS__)))
// clang-format on
#endif
#endif

///@{
/// Determines, in callback_export_data, whether this object's row is recorded this time. Re-enabled before each call.
void enable_data_export(void);
void disable_data_export(void);
///@}

POGO_END_API
#ifdef __cplusplus
}
#endif

#define POGO_CONFIGURABLE_TYPES                                                                                    \
    "init_from_configuration() reads variables of type bool, float, double, int8_t to int32_t and uint8_t to "     \
    "uint32_t; use init_array_from_configuration() for arrays of float, double or char (texts), and one call for " \
    "each member of a struct"
#define POGO_CONFIGURABLE_ARRAYS                                                                                     \
    "init_array_from_configuration() reads arrays of float, double or char (texts) whose size the compiler knows; "  \
    "for a pointer, give the size to init_float_array_from_configuration(), init_double_array_from_configuration() " \
    "or init_string_from_configuration()"
#ifdef __cplusplus
extern "C++" {
template <class T>
POGO_INLINE void pogosim_init_variable(T&, char const*) {
    static_assert(sizeof(T) == 0, POGO_CONFIGURABLE_TYPES);
}
POGO_INLINE void pogosim_init_variable(bool& v, char const* name) {
    init_bool_from_configuration(&v, name, v);
}
POGO_INLINE void pogosim_init_variable(float& v, char const* name) {
    init_float_from_configuration(&v, name, v);
}
POGO_INLINE void pogosim_init_variable(double& v, char const* name) {
    init_double_from_configuration(&v, name, v);
}
POGO_INLINE void pogosim_init_variable(int32_t& v, char const* name) {
    init_int32_from_configuration(&v, name, v);
}
POGO_INLINE void pogosim_init_variable(uint32_t& v, char const* name) {
    init_uint32_from_configuration(&v, name, v);
}
POGO_INLINE void pogosim_init_variable(int16_t& v, char const* name) {
    init_int16_from_configuration(&v, name, v);
}
POGO_INLINE void pogosim_init_variable(uint16_t& v, char const* name) {
    init_uint16_from_configuration(&v, name, v);
}
POGO_INLINE void pogosim_init_variable(int8_t& v, char const* name) {
    init_int8_from_configuration(&v, name, v);
}
POGO_INLINE void pogosim_init_variable(uint8_t& v, char const* name) {
    init_uint8_from_configuration(&v, name, v);
}
template <class T>
POGO_INLINE void pogosim_init_array(T&, char const*) {
    static_assert(sizeof(T) == 0, POGO_CONFIGURABLE_ARRAYS);
}
template <size_t N>
POGO_INLINE void pogosim_init_array(float (&a)[N], char const* name) {
    init_float_array_from_configuration(a, name, N);
}
template <size_t N>
POGO_INLINE void pogosim_init_array(double (&a)[N], char const* name) {
    init_double_array_from_configuration(a, name, N);
}
template <size_t N>
POGO_INLINE void pogosim_init_array(char (&a)[N], char const* name) {
    init_string_from_configuration(a, name, N);
}
}
/// Sets a variable from `parameters` by its own name, as in `init_from_configuration(walk.speed)` for
/// `parameters.walk.speed`; its present value is the default.
#define init_from_configuration(variable) \
    (POGO_NOTE_CONFIGURED(variable, ), pogosim_init_variable((variable), #variable))
/// The same for arrays of float or double, and for strings (arrays of char).
#define init_array_from_configuration(array) (POGO_NOTE_CONFIGURED(array, ), pogosim_init_array((array), #array))
#else
// clang-format off
#define POGO_CHECK_CONFIGURABLE(variable)                                                                       \
    __extension__({ _Static_assert(                                                                             \
        _Generic((variable), bool: 1, float: 1, double: 1, int32_t: 1, uint32_t: 1, int16_t: 1, uint16_t: 1,    \
                 int8_t: 1, uint8_t: 1, default: 0), POGO_CONFIGURABLE_TYPES); })
// An array is of another type than a pointer to its first element.
#define POGO_CHECK_CONFIGURABLE_ARRAY(array)                                                                    \
    __extension__({ _Static_assert(                                                                             \
        _Generic(&(array)[0], float *: 1, double *: 1, char *: 1, default: 0) &&                                \
            !__builtin_types_compatible_p(__typeof__(array), __typeof__(&(array)[0])),                          \
        POGO_CONFIGURABLE_ARRAYS); })
// Never called: the assertion has said why.
void pogosim_init_unsupported(void const* variable, char const* name, ...);
/// Sets a variable from `parameters` by its own name, as in `init_from_configuration(walk.speed)` for
/// `parameters.walk.speed`; its present value is the default. Types: bool, float, double and integers of up to 32 bits.
#define init_from_configuration(variable)               \
    (POGO_NOTE_CONFIGURED(variable, ), POGO_CHECK_CONFIGURABLE(variable), __extension__ _Generic((variable), \
        bool: init_bool_from_configuration,             \
        float: init_float_from_configuration,           \
        double: init_double_from_configuration,         \
        int32_t: init_int32_from_configuration,         \
        uint32_t: init_uint32_from_configuration,       \
        int16_t: init_int16_from_configuration,         \
        uint16_t: init_uint16_from_configuration,       \
        int8_t: init_int8_from_configuration,           \
        uint8_t: init_uint8_from_configuration,         \
        default: pogosim_init_unsupported)(&(variable), #variable, (variable)))
/// The same for arrays of float or double, and for strings (arrays of char).
#define init_array_from_configuration(array)            \
    (POGO_NOTE_CONFIGURED(array, ), POGO_CHECK_CONFIGURABLE_ARRAY(array), __extension__ _Generic(&(array)[0], \
        float *: init_float_array_from_configuration,   \
        double *: init_double_array_from_configuration, \
        char *: init_string_from_configuration,         \
        default: pogosim_init_unsupported)((array), #array, sizeof(array) / sizeof((array)[0])))
// clang-format on
#endif

// A call of one of the functions notes the same. (Inside a macro, its own name is the function's.)
#ifndef POGOSIM_INSIDE
// clang-format off
#define init_bool_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_bool_from_configuration(__VA_ARGS__))
#define init_float_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_float_from_configuration(__VA_ARGS__))
#define init_double_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_double_from_configuration(__VA_ARGS__))
#define init_int32_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_int32_from_configuration(__VA_ARGS__))
#define init_uint32_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_uint32_from_configuration(__VA_ARGS__))
#define init_int16_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_int16_from_configuration(__VA_ARGS__))
#define init_uint16_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_uint16_from_configuration(__VA_ARGS__))
#define init_int8_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_int8_from_configuration(__VA_ARGS__))
#define init_uint8_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_uint8_from_configuration(__VA_ARGS__))
#define init_float_array_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_float_array_from_configuration(__VA_ARGS__))
#define init_double_array_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_double_array_from_configuration(__VA_ARGS__))
#define init_string_from_configuration(...) \
    (POGO_NOTE_CONFIGURED(__VA_ARGS__), init_string_from_configuration(__VA_ARGS__))
// clang-format on
#endif

#endif
