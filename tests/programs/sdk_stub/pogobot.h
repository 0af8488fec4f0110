// Declarations of the Pogobot SDK (pogolib 2.6), as far as programs and the interface layer use them, to check that
// they compile for the robots. There is no code behind them.
#ifndef POGOBOT_H
#define POGOBOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define POGOLIB_RELEASE_VERSION "v2.7"
#ifndef MAX_PAYLOAD_SIZE_BYTES
#define MAX_PAYLOAD_SIZE_BYTES 382
#endif
#ifndef MAX_NUMBER_OF_WORD
#define MAX_NUMBER_OF_WORD 20
#endif
#define IR_RX_COUNT 4
#define NUMEL 20

// Infrared.
typedef struct message_header_t {
    uint8_t _packet_type;
    uint8_t _emitting_power_list;
    uint16_t _sender_id;
    uint8_t _sender_ir_index;
    uint8_t _receiver_ir_index;
    uint16_t payload_length;
} message_header_t;
typedef struct message_t {
    message_header_t header;
    uint8_t payload[MAX_PAYLOAD_SIZE_BYTES];
} message_t;
typedef struct message_short_header_t {
    uint8_t _packet_type;
    uint16_t payload_length;
} message_short_header_t;
typedef struct short_message_t {
    message_short_header_t header;
    uint8_t payload[MAX_PAYLOAD_SIZE_BYTES];
} short_message_t;
typedef struct {
    uint32_t overflow_counter;
    uint32_t unknown_escaped_byte_counter;
    uint32_t crc_mismatch_counter;
} slip_error_counter_s;
typedef enum ir_direction { ir_front = 0, ir_right = 1, ir_back = 2, ir_left = 3, ir_all = 4 } ir_direction;
typedef enum ir_type_message { ir_t_cmd = 1, ir_t_flash = 2, ir_t_short = 3, ir_t_user = 16 } ir_type_message;
#define pogobot_infrared_emitter_power_max 3
#define pogobot_infrared_emitter_power_twoThird 2
#define pogobot_infrared_emitter_power_oneThird 1
#define pogobot_infrared_emitter_power_null 0
#define pogobot_infrared_emitter_width_bits 2
#define pogobot_infrared_emitting_power_list(front, right, back, left) \
    ((front) | ((right) << 2) | ((back) << 4) | ((left) << 6))
enum {
    pogobot_infrared_emitting_power_list_front_full = 3,
    pogobot_infrared_emitting_power_list_right_full = 12,
    pogobot_infrared_emitting_power_list_back_full = 48,
    pogobot_infrared_emitting_power_list_left_full = 192,
    pogobot_infrared_emitting_power_list_all_full = 255
};

uint32_t pogobot_infrared_sendLongMessage_omniGen(uint8_t* message, uint16_t message_size);
uint32_t pogobot_infrared_sendLongMessage_omniSpe(uint8_t* message, uint16_t message_size);
uint32_t pogobot_infrared_sendLongMessage_uniSpe(ir_direction dir, uint8_t* message, uint16_t message_size);
uint32_t pogobot_infrared_sendShortMessage_omni(uint8_t* message, uint16_t message_size);
uint32_t pogobot_infrared_sendShortMessage_uni(ir_direction dir, uint8_t* message, uint16_t message_size);
uint32_t pogobot_infrared_sendRawLongMessage(message_t* message);
uint32_t pogobot_infrared_sendRawShortMessage(ir_direction dir, short_message_t* message);
void pogobot_infrared_set_power(uint8_t power);
void pogobot_infrared_update(void);
int pogobot_infrared_message_available(void);
void pogobot_infrared_recover_next_message(message_t* message);
void pogobot_infrared_clear_message_queue(void);
void pogobot_infrared_get_receiver_error_counter(slip_error_counter_s* counter, uint8_t ir_index);
void pogobot_infrared_reset_receiver_error_counter(void);
void pogobot_infrared_ll_init(void);

// Start-up, identity, battery.
void pogobot_init(void);
uint16_t pogobot_helper_getid(void);
int16_t pogobot_helper_getRandSeed(void);
void pogobot_helper_print_version(void);
int16_t pogobot_battery_voltage_read(void);

// LEDs.
void pogobot_led_setColor(uint8_t r, uint8_t g, uint8_t b);
void pogobot_led_setColors(uint8_t r, uint8_t g, uint8_t b, uint8_t id);

// Motors.
typedef enum { motorR = 0, motorL = 1, motorB = 2 } motor_id;
typedef enum {
    motorStop = 0,
    motorQuarter = 256,
    motorHalf = 512,
    motorThreeQuarter = 716,
    motorFull = 1023
} motor_range;
void pogobot_motor_power_set(motor_id motor, uint16_t value);
void pogobot_motor_set(motor_id motor, uint16_t value);
void pogobot_motor_dir_set(motor_id motor, uint8_t value);
uint32_t pogobot_motor_dir_current_status(void);
int8_t pogobot_motor_dir_mem_get(uint8_t* directions);
int8_t pogobot_motor_dir_mem_set(uint8_t* directions);
uint8_t pogobot_motor_power_mem_get(uint16_t* powers);
uint8_t pogobot_motor_power_mem_set(uint16_t* powers);

// Sensors.
typedef enum { p_B = 0, p_FL = 1, p_FR = 2 } photosensor_id;
int16_t pogobot_photosensors_read(uint8_t sensor_number);
void pogobot_imu_read(float* acc, float* gyro);
float pogobot_imu_readTemp(void);
uint8_t magn_init(void);
int magn_read_XYZ(int16_t* x, int16_t* y, int16_t* z, uint16_t timeout_ms);
void magn_begin(void);
void magn_end(void);

// Flash.
#define POGOBOT_USER_FLASH_START_OFFSET 0x90000u
#define POGOBOT_USER_FLASH_PAGE_SIZE 256u
#define POGOBOT_USER_FLASH_PAGE_COUNT 5888u
void read_page_flash(uint16_t page, char* buf);
void write_page_flash(uint16_t page, const void* data);
void erase_write_section_flash(void);

// Time.
typedef struct time_reference_t {
    uint32_t hardware_value_at_time_origin;
} time_reference_t;
void pogobot_stopwatch_reset(time_reference_t* stopwatch);
int32_t pogobot_stopwatch_get_elapsed_microseconds(time_reference_t* stopwatch);
int32_t pogobot_stopwatch_lap(time_reference_t* stopwatch);
void pogobot_stopwatch_offset_origin_microseconds(time_reference_t* stopwatch, int32_t microseconds_offset);
void pogobot_timer_init(time_reference_t* timer, int32_t microseconds_to_go);
int32_t pogobot_timer_get_remaining_microseconds(time_reference_t* timer);
bool pogobot_timer_has_expired(time_reference_t* timer);
void pogobot_timer_wait_for_expiry(time_reference_t* timer);
void pogobot_timer_offset_origin_microseconds(time_reference_t* timer, int32_t microseconds_offset);
void msleep(int milliseconds);

#endif
