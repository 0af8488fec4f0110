/// @file
/// Infrared messages. Four emitters and four receiving faces: front, right, back, left. docs/communication.md explains
/// which robots hear each other, and how often. A message is delivered at the end of the simulation step in which it
/// was sent.
#ifndef POGOSIM_POGOLIB_INFRARED_H
#define POGOSIM_POGOLIB_INFRARED_H

#ifndef MAX_PAYLOAD_SIZE_BYTES
/// Maximum payload of a message, bytes. A program may define a smaller one before the include: this makes message_t
/// smaller, and longer payloads are truncated on reception.
#define MAX_PAYLOAD_SIZE_BYTES 382
#endif
#ifndef MAX_NUMBER_OF_WORD
/// For compatibility; the simulator does not use it.
#define MAX_NUMBER_OF_WORD 20
#endif

/// Number of receivers.
#define IR_RX_COUNT 4
/// Capacity of a real robot's message queue; in the simulator it is `message_queue_size`, by default the same.
#define NUMEL 20

/// Faces of a robot; `ir_all`: all four.
typedef enum ir_direction { ir_front = 0, ir_right = 1, ir_back = 2, ir_left = 3, ir_all = 4 } ir_direction;

/// Kinds of packets; programs send and receive ir_t_short and ir_t_user.
typedef enum ir_type_message { ir_t_cmd = 1, ir_t_flash = 2, ir_t_short = 3, ir_t_user = 16 } ir_type_message;

/// Header of a long message.
typedef struct message_header_t {
    uint8_t _packet_type;          ///< ir_type_message
    uint8_t _emitting_power_list;  ///< two bits per emitter, front lowest; 0 in a short message
    uint16_t _sender_id;           ///< 0xFF in a short message
    uint8_t _sender_ir_index;      ///< emitter, 4 for all; of two or three, the first; 0xF in a short message
    uint8_t _receiver_ir_index;    ///< face that received it
    uint16_t payload_length;       ///< bytes
} message_header_t;

/// A long message; receivers get messages of both kinds in this form.
typedef struct message_t {
    message_header_t header;                  ///< set by the sending and receiving functions
    uint8_t payload[MAX_PAYLOAD_SIZE_BYTES];  ///< payload_length bytes of it count
} message_t;

/// Header of a short message.
typedef struct message_short_header_t {
    uint8_t _packet_type;     ///< ir_type_message
    uint16_t payload_length;  ///< bytes
} message_short_header_t;

/// A short message.
typedef struct short_message_t {
    message_short_header_t header;            ///< set by the sending functions
    uint8_t payload[MAX_PAYLOAD_SIZE_BYTES];  ///< payload_length bytes of it count
} short_message_t;

// The type of slip_send_descriptor, which stands for the infrared emitters in slip.h.
struct pogosim_slip_descriptor {
    uint32_t crc_seed;                    ///< of the checksum
    uint8_t (*write_byte)(uint8_t byte);  ///< sends one byte
};

/// Error counters of one receiver of a real robot. All zero in the simulator, which loses whole messages.
typedef struct {
    uint32_t overflow_counter;              ///< messages longer than the buffer
    uint32_t unknown_escaped_byte_counter;  ///< wrong bytes after an escape
    uint32_t crc_mismatch_counter;          ///< wrong checksums
} slip_error_counter_s;

/// Power of each emitter, 0 to 3, a byte each.
typedef union emitting_power_list_t {
    uint32_t number;  ///< all four
    struct {
        uint8_t front, left, back, right;
    } fields;          ///< by name
    uint8_t array[4];  ///< in the order of the fields
} emitting_power_list_t;

///@{
/// A power for pogobot_infrared_set_power() and pogobot_infrared_emitting_power_list().
#define pogobot_infrared_emitter_power_max 3
#define pogobot_infrared_emitter_power_twoThird 2
#define pogobot_infrared_emitter_power_oneThird 1
#define pogobot_infrared_emitter_power_null 0
///@}

/// Bits per power in a list.
#define pogobot_infrared_emitter_width_bits 2

/// List of four powers, 0 to 3, for `_emitting_power_list` of a raw long message.
#define pogobot_infrared_emitting_power_list(front, right, back, left)                                                 \
    (((front) << (0 * pogobot_infrared_emitter_width_bits)) | ((right) << (1 * pogobot_infrared_emitter_width_bits)) | \
     ((back) << (2 * pogobot_infrared_emitter_width_bits)) | ((left) << (3 * pogobot_infrared_emitter_width_bits)))

/// Lists with one emitter, or all, at full power.
enum {
    pogobot_infrared_emitting_power_list_front_full = 3,
    pogobot_infrared_emitting_power_list_right_full = 12,
    pogobot_infrared_emitting_power_list_back_full = 48,
    pogobot_infrared_emitting_power_list_left_full = 192,
    pogobot_infrared_emitting_power_list_all_full = 255
};

/// Power of emitter `dir` (0 to 3) in a list.
#define get_infrared_emitter_dir(dir, list) \
    (((list) >> ((dir)*pogobot_infrared_emitter_width_bits)) & pogobot_infrared_emitter_power_max)

///@{
/// The lowest bit of byte `index` of a word, or of the byte of an emitter, in the order of ir_direction.
#define pogobot_infrared_emitter_mask_byindex(index) (1 << (8 * (index)))
#define pogobot_infrared_emitter_front_mask pogobot_infrared_emitter_mask_byindex(0)
#define pogobot_infrared_emitter_right_mask pogobot_infrared_emitter_mask_byindex(1)
#define pogobot_infrared_emitter_back_mask pogobot_infrared_emitter_mask_byindex(2)
#define pogobot_infrared_emitter_left_mask pogobot_infrared_emitter_mask_byindex(3)
///@}

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

// Sending. These functions return 0 on success, whereas msg_tx_fn returns true if it sent a message. While the robot is
// muted, they send nothing and return the number of messages that were not sent.

/// Sends a long message (8 bytes of header and `message_size` of payload) through all emitters at once; receivers see
/// `_sender_ir_index` 4. Returns 0, or 1 if nothing was sent because the payload is longer than 382 bytes or NULL.
/// @range message_size: bytes, 0 to 382; returns 0: sent, 1: not
uint32_t pogobot_infrared_sendLongMessage_omniGen(uint8_t* const message, uint16_t const message_size);
/// Sends four long messages, one through each emitter, so that receivers see which one. Returns 0, or the number of
/// messages that were not sent.
/// @range message_size: bytes, 0 to 382; returns how many of the four were not sent, 0 to 4
uint32_t pogobot_infrared_sendLongMessage_omniSpe(uint8_t* const message, uint16_t const message_size);
/// Sends a long message through one emitter; with `ir_all`, like pogobot_infrared_sendLongMessage_omniGen(). Same
/// return values.
/// @range message_size: bytes, 0 to 382; returns 0: sent, 1: not
uint32_t pogobot_infrared_sendLongMessage_uniSpe(ir_direction dir, uint8_t* const message, uint16_t const message_size);
/// Sends a short message (3 bytes of header: no sender, no emitter) through all emitters at once. Returns 0, or 1 if
/// nothing was sent because the payload is longer than 382 bytes or NULL.
/// @range message_size: bytes, 0 to 382; returns 0: sent, 1: not
uint32_t pogobot_infrared_sendShortMessage_omni(uint8_t* const message, uint16_t const message_size);
/// Sends a short message through one emitter, or with `ir_all` through all at once. Same return values.
/// @range message_size: bytes, 0 to 382; returns 0: sent, 1: not
uint32_t pogobot_infrared_sendShortMessage_uni(ir_direction dir, uint8_t* const message, uint16_t const message_size);
/// Sends a long message unchanged, through the emitters whose power in `_emitting_power_list` is not 0. If all are 0,
/// nothing is sent, with a warning. The range is that of the largest of these powers. Sets type and sender; a command
/// of type ir_t_cmd (see is_muted()) remains one, with a warning, as on a real robot it does not. Returns 0,
/// or 1 if nothing was sent because the message is NULL or `payload_length` is above 382.
/// @range payload_length: bytes, 0 to 382; returns 0: sent, 1: not
uint32_t pogobot_infrared_sendRawLongMessage(message_t* const message);
/// Sends a short message unchanged, through one emitter or, with `ir_all`, all. Sets the type. Same return values as
/// for long ones.
/// @range payload_length: bytes, 0 to 382; returns 0: sent, 1: not
uint32_t pogobot_infrared_sendRawShortMessage(ir_direction dir, short_message_t* const message);

/// Power of the emitters for the functions above except raw long messages: 0 to 3 (more counts as 3), initially 1. 0
/// sends nothing. In the simulator, `communication_radius_by_power` sets the ranges of 1 to 3; by default they are
/// equal.
/// @range power: 0 (silent) to 3
void pogobot_infrared_set_power(uint8_t power);

// Receiving, without msg_rx_fn. When the queue is full, new messages are dropped.

/// Decodes received data on a real robot, which gets no messages without it; does nothing in the simulator. The main
/// loop of pogobase.h calls it if msg_rx_fn is set: a user_step that reads messages itself calls it first.
void pogobot_infrared_update(void);
/// Non-zero if a message is waiting. A loop that waits for it goes on when a message comes; call
/// pogobot_infrared_update() and msleep() in it.
/// @range returns 0: none, or another number
int pogobot_infrared_message_available(void);
/// Drops all waiting messages.
void pogobot_infrared_clear_message_queue(void);
#ifndef REAL_ROBOT
// See pogobot_infrared_recover_next_message.
void pogosim_recover_next_message(message_t* message, size_t max_payload_bytes);
#else
void pogobot_infrared_recover_next_message(message_t* message);
#endif

/// Error counters of receiver `ir_index`, 0 to 3: always zero in the simulator. NULL does nothing.
/// @range ir_index: 0 to 3
void pogobot_infrared_get_receiver_error_counter(slip_error_counter_s* const counter, uint8_t ir_index);
/// Resets the error counters of a real robot; does nothing in the simulator.
void pogobot_infrared_reset_receiver_error_counter(void);

/// Messages that were lost because the queue was full, since the infrared hardware was initialised.
/// @range returns from 0
uint32_t pogobot_infrared_get_queue_drop_count(void);
/// Packets that were not passed on because the lengths in them were wrong, since the infrared hardware was initialised:
/// one for each receiver. Only raw packets (slip.h) can be malformed.
/// @range returns from 0
uint32_t pogobot_infrared_get_malformed_count(void);

/// Initialises the infrared hardware: empties the queue, unmutes the robot and sets the counters of lost and malformed
/// messages to 0. A robot does this when it starts.
void pogobot_infrared_ll_init(void);

/// 1 if the robot is muted, i.e. sends no messages, else 0. pogobot_infrared_update() obeys commands of the remote
/// control, packets of type ir_t_cmd whose payload begins with `DEADCAFE` (mute), `BASECAFE` (unmute) or `DEADBEEF`
/// (restart: the program begins anew). The program receives these packets, too.
/// @range returns 0 or 1
int is_muted(void);
#ifndef REAL_ROBOT
/// What is_muted() tells, as a variable: not 0 mutes the robot.
#define _master_mute (*pogosim_master_mute())
uint8_t* pogosim_master_mute(void);
#else
extern uint8_t _master_mute;
#endif

/// Clears interrupt flags of a real robot; does nothing in the simulator.
void IR_reset_interrupt_flags(void);

#ifndef REAL_ROBOT
// What slip.h sends with. `declared_length`: of the payload; -1: as its header says.
int pogosim_send_packet(void const* descriptor, uint8_t const* data, uint32_t size, int64_t declared_length);
#endif

POGO_END_API

#ifndef REAL_ROBOT
/// Removes the oldest message from the queue; bytes beyond its payload are zero. If no message is waiting, warns once
/// and leaves the argument unchanged.
static POGO_INLINE void pogobot_infrared_recover_next_message(message_t* message) {
    pogosim_recover_next_message(message, MAX_PAYLOAD_SIZE_BYTES);
}
#endif

// Records in the program what a call sends, for pogosim-shared-state: a constant with the text of its arguments, in the
// scope in which that text is valid. A call begins with the name of its function, so that a member of this name can be
// called, too. (Inside a macro, its own name is the function's.)
#if !defined(REAL_ROBOT) && !defined(POGOSIM_INSIDE)
#ifdef __cplusplus
#define POGO_NO_MESSAGE static_cast<uint8_t*>(nullptr)
#define POGO_NO_DIRECTION ir_front
#else
#define POGO_NO_MESSAGE NULL
#define POGO_NO_DIRECTION 0
#endif
// Is false: `POGO_NOTE_SENT(message, size) ? NULL : message, size` are the same arguments, however many commas there
// are in braces. (Volatile: clang would leave the text out if it knew the result.)
#define POGO_NOTE_SENT(...)                                                                      \
    __extension__({                                                                              \
        static char const pogosim_sent_arguments[] __attribute__((used, unused)) = #__VA_ARGS__; \
        char const* volatile pogosim_sent = pogosim_sent_arguments;                              \
        !pogosim_sent;                                                                           \
    })
// clang-format off
#define pogobot_infrared_sendLongMessage_omniGen(...) \
    pogobot_infrared_sendLongMessage_omniGen(POGO_NOTE_SENT(__VA_ARGS__) ? POGO_NO_MESSAGE : __VA_ARGS__)
#define pogobot_infrared_sendLongMessage_omniSpe(...) \
    pogobot_infrared_sendLongMessage_omniSpe(POGO_NOTE_SENT(__VA_ARGS__) ? POGO_NO_MESSAGE : __VA_ARGS__)
#define pogobot_infrared_sendLongMessage_uniSpe(...) \
    pogobot_infrared_sendLongMessage_uniSpe(POGO_NOTE_SENT(__VA_ARGS__) ? POGO_NO_DIRECTION : __VA_ARGS__)
#define pogobot_infrared_sendShortMessage_omni(...) \
    pogobot_infrared_sendShortMessage_omni(POGO_NOTE_SENT(__VA_ARGS__) ? POGO_NO_MESSAGE : __VA_ARGS__)
#define pogobot_infrared_sendShortMessage_uni(...) \
    pogobot_infrared_sendShortMessage_uni(POGO_NOTE_SENT(__VA_ARGS__) ? POGO_NO_DIRECTION : __VA_ARGS__)
// clang-format on
#endif

#ifdef __cplusplus
}
#endif

#endif
