// Calls one function of the interface with NULL for one of its pointers, as the parameter `call` says.
#include "pogobase.h"

typedef struct {
    time_reference_t watch;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

char call[80] = "";
static char const* const none = NULL;

#define FOR_NULL(name, ...)         \
    if (strcmp(call, #name) == 0) { \
        __VA_ARGS__;                \
    }

static void no_arguments(char const* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vprintf(none, arguments);
    va_end(arguments);
}

static void user_step(void) {
    uint8_t r = 0, g = 0, b = 0;
    float three[3] = {0.0f, 0.0f, 0.0f};
    int16_t count = 0;
    bool a_bool = false;

    FOR_NULL(printf.format, printf(none))
    FOR_NULL(vprintf.format, no_arguments("none"))
    FOR_NULL(puts.text, puts(none))
    FOR_NULL(pogobot_stopwatch_reset.stopwatch, pogobot_stopwatch_reset(NULL))
    FOR_NULL(pogobot_stopwatch_get_elapsed_microseconds.stopwatch, pogobot_stopwatch_get_elapsed_microseconds(NULL))
    FOR_NULL(pogobot_stopwatch_lap.stopwatch, pogobot_stopwatch_lap(NULL))
    FOR_NULL(pogobot_stopwatch_offset_origin_microseconds.stopwatch,
             pogobot_stopwatch_offset_origin_microseconds(NULL, 1))
    FOR_NULL(pogobot_timer_init.timer, pogobot_timer_init(NULL, 1))
    FOR_NULL(pogobot_timer_get_remaining_microseconds.timer, pogobot_timer_get_remaining_microseconds(NULL))
    FOR_NULL(pogobot_timer_has_expired.timer, pogobot_timer_has_expired(NULL))
    FOR_NULL(pogobot_timer_wait_for_expiry.timer, pogobot_timer_wait_for_expiry(NULL))
    FOR_NULL(pogobot_timer_offset_origin_microseconds.timer, pogobot_timer_offset_origin_microseconds(NULL, 1))
    FOR_NULL(pogobot_imu_read.acc, pogobot_imu_read(NULL, three))
    FOR_NULL(pogobot_imu_read.gyro, pogobot_imu_read(three, NULL))
    FOR_NULL(read_page_flash.buf, read_page_flash(0, NULL))
    FOR_NULL(write_page_flash.data, write_page_flash(0, NULL))
    FOR_NULL(magn_read_XYZ.x, magn_read_XYZ(NULL, &count, &count, 20))
    FOR_NULL(magn_read_XYZ.y, magn_read_XYZ(&count, NULL, &count, 20))
    FOR_NULL(magn_read_XYZ.z, magn_read_XYZ(&count, &count, NULL, 20))
    FOR_NULL(pogobot_infrared_recover_next_message.message, pogobot_infrared_recover_next_message(NULL))
    FOR_NULL(pogobot_infrared_sendLongMessage_omniGen.message, pogobot_infrared_sendLongMessage_omniGen(NULL, 4))
    FOR_NULL(pogobot_infrared_sendLongMessage_omniSpe.message, pogobot_infrared_sendLongMessage_omniSpe(NULL, 4))
    FOR_NULL(pogobot_infrared_sendLongMessage_uniSpe.message,
             pogobot_infrared_sendLongMessage_uniSpe(ir_front, NULL, 4))
    FOR_NULL(pogobot_infrared_sendShortMessage_omni.message, pogobot_infrared_sendShortMessage_omni(NULL, 4))
    FOR_NULL(pogobot_infrared_sendShortMessage_uni.message, pogobot_infrared_sendShortMessage_uni(ir_front, NULL, 4))
    FOR_NULL(pogobot_infrared_sendRawLongMessage.message, pogobot_infrared_sendRawLongMessage(NULL))
    FOR_NULL(pogobot_infrared_sendRawShortMessage.message, pogobot_infrared_sendRawShortMessage(ir_front, NULL))
    FOR_NULL(pogobot_infrared_get_receiver_error_counter.counter, pogobot_infrared_get_receiver_error_counter(NULL, 0))
    FOR_NULL(pogobot_motor_dir_mem_get.p_directions, pogobot_motor_dir_mem_get(NULL))
    FOR_NULL(pogobot_motor_dir_mem_set.p_directions, pogobot_motor_dir_mem_set(NULL))
    FOR_NULL(pogobot_motor_power_mem_get.p_powers, pogobot_motor_power_mem_get(NULL))
    FOR_NULL(pogobot_motor_power_mem_set.p_powers, pogobot_motor_power_mem_set(NULL))
    FOR_NULL(qualitative_colormap.r, qualitative_colormap(1, NULL, &g, &b))
    FOR_NULL(qualitative_colormap.g, qualitative_colormap(1, &r, NULL, &b))
    FOR_NULL(qualitative_colormap.b, qualitative_colormap(1, &r, &g, NULL))
    FOR_NULL(rainbow_colormap.r, rainbow_colormap(1, NULL, &g, &b))
    FOR_NULL(rainbow_colormap.g, rainbow_colormap(1, &r, NULL, &b))
    FOR_NULL(rainbow_colormap.b, rainbow_colormap(1, &r, &g, NULL))
    FOR_NULL(hsv_to_rgb.r, hsv_to_rgb(1, 1, 1, NULL, &g, &b))
    FOR_NULL(hsv_to_rgb.g, hsv_to_rgb(1, 1, 1, &r, NULL, &b))
    FOR_NULL(hsv_to_rgb.b, hsv_to_rgb(1, 1, 1, &r, &g, NULL))
    FOR_NULL(current_robot_category_is.category, a_bool = current_robot_category_is(NULL);
             printf("category %d\n", a_bool))
    FOR_NULL(_pogobot_start.category, pogobot_start(NULL, NULL, NULL))
    FOR_NULL(_pogobot_start.user_step, pogobot_start(NULL, NULL))
    FOR_NULL(_pogobot_start.user_init, pogobot_start(NULL, NULL))
    FOR_NULL(refuse_parameter.name, refuse_parameter(NULL, "a number"))
    FOR_NULL(refuse_parameter.expected, refuse_parameter("call", NULL))
    FOR_NULL(check_parameter_range.name, check_parameter_range(NULL, 1, 0, 2))
    FOR_NULL(pogo_main_loop_step.user_step, pogo_main_loop_step(NULL))

#define FOR_CONFIGURATION(function, value, ...)                                 \
    FOR_NULL(function.variable, function(NULL, "name", value))                  \
    FOR_NULL(function.array, function(NULL, "name", value))                     \
    FOR_NULL(function.text, function(NULL, "name", value))                      \
    if (strncmp(call, #function ".name", sizeof(#function ".name") - 1) == 0) { \
        __VA_ARGS__ variable[2] = {0, 0};                                       \
        function(variable, NULL, value);                                        \
    }
    FOR_CONFIGURATION(init_bool_from_configuration, true, bool)
    FOR_CONFIGURATION(init_float_from_configuration, 1, float)
    FOR_CONFIGURATION(init_double_from_configuration, 1, double)
    FOR_CONFIGURATION(init_int32_from_configuration, 1, int32_t)
    FOR_CONFIGURATION(init_uint32_from_configuration, 1, uint32_t)
    FOR_CONFIGURATION(init_int16_from_configuration, 1, int16_t)
    FOR_CONFIGURATION(init_uint16_from_configuration, 1, uint16_t)
    FOR_CONFIGURATION(init_int8_from_configuration, 1, int8_t)
    FOR_CONFIGURATION(init_uint8_from_configuration, 1, uint8_t)
    FOR_CONFIGURATION(init_float_array_from_configuration, 2, float)
    FOR_CONFIGURATION(init_double_array_from_configuration, 2, double)
    FOR_CONFIGURATION(init_string_from_configuration, 2, char)
}

static void export_data(void) {
    FOR_NULL(data_set_value_int8.name, data_set_value_int8(NULL, 1))
    FOR_NULL(data_set_value_int16.name, data_set_value_int16(NULL, 1))
    FOR_NULL(data_set_value_int32.name, data_set_value_int32(NULL, 1))
    FOR_NULL(data_set_value_int64.name, data_set_value_int64(NULL, 1))
    FOR_NULL(data_set_value_float.name, data_set_value_float(NULL, 1.0f))
    FOR_NULL(data_set_value_double.name, data_set_value_double(NULL, 1.0))
    FOR_NULL(data_set_value_string.name, data_set_value_string(NULL, "x"))
    FOR_NULL(data_set_value_string.value, data_set_value_string("text", NULL))
    FOR_NULL(data_set_value_bool.name, data_set_value_bool(NULL, true))
    FOR_NULL(data_set_value_float16.name, data_set_value_float16(NULL, 1.0f))
}

static void create_data_schema(void) {
    data_add_column_string("text");
    FOR_NULL(data_add_column_int8.name, data_add_column_int8(NULL))
    FOR_NULL(data_add_column_int16.name, data_add_column_int16(NULL))
    FOR_NULL(data_add_column_int32.name, data_add_column_int32(NULL))
    FOR_NULL(data_add_column_int64.name, data_add_column_int64(NULL))
    FOR_NULL(data_add_column_float.name, data_add_column_float(NULL))
    FOR_NULL(data_add_column_double.name, data_add_column_double(NULL))
    FOR_NULL(data_add_column_string.name, data_add_column_string(NULL))
    FOR_NULL(data_add_column_bool.name, data_add_column_bool(NULL))
    FOR_NULL(data_add_column_float16.name, data_add_column_float16(NULL))
}

static void global_step(void) {
    pogosim_pose_t pose;
    pogosim_velocity_t velocity;
    uint8_t r = 0, g = 0, b = 0;
    double x_mm = 0.0, y_mm = 0.0;
    pogosim_world_pose(0, &pose);
    pogosim_world_velocity(0, &velocity);
    pogosim_world_led(0, 0, &r, &g, &b);
    pogosim_link_t link = pogosim_world_new_link(POGOSIM_SPRING, 0, POGOSIM_ARENA);
    link.stiffness_n_m = 1.0;
    pogosim_world_add_link(&link);
    FOR_NULL(world_category_size.category, pogosim_world_category_size(NULL))
    FOR_NULL(world_object.category, pogosim_world_object(NULL, 0))
    FOR_NULL(world_pose.pose, pogosim_world_pose(0, NULL))
    FOR_NULL(world_velocity.velocity, pogosim_world_velocity(0, NULL))
    FOR_NULL(world_led.r, pogosim_world_led(0, 0, NULL, &g, &b))
    FOR_NULL(world_led.g, pogosim_world_led(0, 0, &r, NULL, &b))
    FOR_NULL(world_led.b, pogosim_world_led(0, 0, &r, &g, NULL))
    FOR_NULL(world_lamp_position.x_mm, pogosim_world_lamp_position(0, NULL, &y_mm))
    FOR_NULL(world_lamp_position.y_mm, pogosim_world_lamp_position(0, &x_mm, NULL))
    FOR_NULL(world_add_link.link, pogosim_world_add_link(NULL))
    FOR_NULL(world_link.found, pogosim_world_link(0, NULL))
    FOR_NULL(world_link_state.state, pogosim_world_link_state(0, NULL))
    FOR_NULL(world_set_column.name, pogosim_world_set_column(NULL, 1.0))
    FOR_NULL(world_set_object_column.name, pogosim_world_set_object_column(0, NULL, 1.0))
}

static void global_setup(void) {
    init_string_from_configuration(call, "call", sizeof(call));
}

int main(void) {
    pogobot_init();
    pogobot_start(NULL, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_global_step, global_step);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
