// Infrared messages. Four emitters and four receiving faces: front, right, back, left.
#ifndef POGOSIM_POGOLIB_INFRARED_H
#define POGOSIM_POGOLIB_INFRARED_H

/// Longest payload of a message.
#ifndef MAX_PAYLOAD_SIZE_BYTES
#define MAX_PAYLOAD_SIZE_BYTES 382
#endif
#ifndef MAX_NUMBER_OF_WORD
#define MAX_NUMBER_OF_WORD 20
#endif

/// Number of receivers, and of messages a robot's queue holds.
#define IR_RX_COUNT 4
#define NUMEL 20

typedef enum ir_direction { ir_front = 0, ir_right = 1, ir_back = 2, ir_left = 3, ir_all = 4 } ir_direction;

typedef enum ir_type_message { ir_t_cmd = 1, ir_t_flash = 2, ir_t_short = 3, ir_t_user = 16 } ir_type_message;

typedef struct message_header_t {
    uint8_t _packet_type;          ///< ir_type_message
    uint8_t _emitting_power_list;  ///< two bits per emitter, front lowest; 0 in a short message
    uint16_t _sender_id;           ///< 0xFF in a short message
    uint8_t _sender_ir_index;      ///< emitter, 4 for all; 0xF in a short message
    uint8_t _receiver_ir_index;    ///< face that received it
    uint16_t payload_length;       ///< bytes
} message_header_t;

typedef struct message_t {
    message_header_t header;
    uint8_t payload[MAX_PAYLOAD_SIZE_BYTES];
} message_t;

typedef struct message_short_header_t {
    uint8_t _packet_type;
    uint16_t payload_length;  ///< bytes
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

typedef union emitting_power_list_t {
    uint32_t number;
    struct {
        uint8_t front, left, back, right;
    } fields;
    uint8_t array[4];
} emitting_power_list_t;

// Emitter powers, and lists of them.
#define pogobot_infrared_emitter_power_max 3
#define pogobot_infrared_emitter_power_twoThird 2
#define pogobot_infrared_emitter_power_oneThird 1
#define pogobot_infrared_emitter_power_null 0
#define pogobot_infrared_emitter_width_bits 2

#define pogobot_infrared_emitting_power_list(front, right, back, left)                                                 \
    (((front) << (0 * pogobot_infrared_emitter_width_bits)) | ((right) << (1 * pogobot_infrared_emitter_width_bits)) | \
     ((back) << (2 * pogobot_infrared_emitter_width_bits)) | ((left) << (3 * pogobot_infrared_emitter_width_bits)))

enum {
    pogobot_infrared_emitting_power_list_front_full = 3,
    pogobot_infrared_emitting_power_list_right_full = 12,
    pogobot_infrared_emitting_power_list_back_full = 48,
    pogobot_infrared_emitting_power_list_left_full = 192,
    pogobot_infrared_emitting_power_list_all_full = 255
};

/// Power of one emitter in a list.
#define get_infrared_emitter_dir(dir, list) \
    (((list) >> ((dir)*pogobot_infrared_emitter_width_bits)) & pogobot_infrared_emitter_power_max)

#define pogobot_infrared_emitter_mask_byindex(index) (1 << (8 * (index)))
#define pogobot_infrared_emitter_front_mask pogobot_infrared_emitter_mask_byindex(0)
#define pogobot_infrared_emitter_right_mask pogobot_infrared_emitter_mask_byindex(1)
#define pogobot_infrared_emitter_back_mask pogobot_infrared_emitter_mask_byindex(2)
#define pogobot_infrared_emitter_left_mask pogobot_infrared_emitter_mask_byindex(3)

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

// Sending. All return 0, or 1 when the payload is longer than MAX_PAYLOAD_SIZE_BYTES or NULL and nothing was sent.

/// Long message (8 bytes of header) through all emitters at once; receivers see _sender_ir_index 4.
uint32_t pogobot_infrared_sendLongMessage_omniGen(uint8_t* const message, uint16_t const message_size);
/// Long message through each emitter in turn, so that receivers see which one.
uint32_t pogobot_infrared_sendLongMessage_omniSpe(uint8_t* const message, uint16_t const message_size);
/// Long message through one emitter (ir_all: as omniGen).
uint32_t pogobot_infrared_sendLongMessage_uniSpe(ir_direction dir, uint8_t* const message, uint16_t const message_size);
/// Short message (no sender in the header, 3 bytes) through all emitters at once.
uint32_t pogobot_infrared_sendShortMessage_omni(uint8_t* const message, uint16_t const message_size);
/// Short message through one emitter.
uint32_t pogobot_infrared_sendShortMessage_uni(ir_direction dir, uint8_t* const message, uint16_t const message_size);
/// Long message as it is, through the emitters whose power in _emitting_power_list is not 0. Sets type and sender.
uint32_t pogobot_infrared_sendRawLongMessage(message_t* const message);
/// Short message as it is. Sets the type.
uint32_t pogobot_infrared_sendRawShortMessage(ir_direction dir, short_message_t* const message);

/// Power of the emitters, 0 to 3 (more counts as 3). 0 sends nothing; the others reach equally far here.
void pogobot_infrared_set_power(uint8_t power);

// Receiving. The queue holds NUMEL messages; when it is full, new ones are lost.

/// Decodes what has arrived on a real robot; nothing to do here.
void pogobot_infrared_update(void);
/// Non-zero when a message waits.
int pogobot_infrared_message_available(void);
/// Drops all waiting messages.
void pogobot_infrared_clear_message_queue(void);
/// See pogobot_infrared_recover_next_message.
void pogosim_recover_next_message(message_t* message, size_t max_payload_bytes);

/// Error counters of receiver 0 to 3: always zero here.
void pogobot_infrared_get_receiver_error_counter(slip_error_counter_s* const counter, uint8_t ir_index);
void pogobot_infrared_reset_receiver_error_counter(void);

/// Prepares the hardware of a real robot; nothing to do here.
void pogobot_infrared_ll_init(void);

POGO_END_API

/// Takes the oldest message out of the queue; bytes beyond its payload are zero. Warns once and leaves the argument as
/// it is when no message waits.
static inline void pogobot_infrared_recover_next_message(message_t* message) {
    pogosim_recover_next_message(message, MAX_PAYLOAD_SIZE_BYTES);
}

#ifdef __cplusplus
}
#endif

#endif
