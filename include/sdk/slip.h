/// @file
/// Raw infrared packets: a header as in pogobot.h and a payload, as they are. Receivers do not pass on those whose
/// lengths are wrong, and count them (pogobot_infrared_get_malformed_count()). Packets that are sent so are not stopped
/// when the robot is muted. As on the robots, a program that sends one declares the descriptor of the emitters itself:
///
///     extern const slip_send_descriptor_s slip_send_descriptor;
///
/// The encoding of bytes is not simulated.
#ifndef POGOSIM_SDK_SLIP_H
#define POGOSIM_SDK_SLIP_H

#include "pogosim_hardware.h"

#define SLIP_SPECIAL_BYTE_END 0xC0
#define SLIP_SPECIAL_BYTE_ESC 0xDB
#define SLIP_ESCAPED_BYTE_END 0xDC
#define SLIP_ESCAPED_BYTE_ESC 0xDD

typedef enum {
    SLIP_NO_ERROR = 0,
    SLIP_ERROR_BUFFER_OVERFLOW,
    SLIP_ERROR_UNKNOWN_ESCAPED_BYTE,
    SLIP_ERROR_CRC_MISMATCH
} slip_error_t;

typedef struct pogosim_slip_descriptor slip_send_descriptor_s;
typedef struct pogosim_slip_receive_state slip_receive_state_s;

/// Sends `size` bytes, header and payload: `slip_send_message(&slip_send_descriptor, data, size)`, or since SDK 2.7.1
/// with the length of the payload as a fourth argument, which the receivers compare with that in the header. Long ones
/// go through the emitters of `_emitting_power_list`, or all if it is 0.
#define slip_send_message(...) POGO_SLIP_PICK(__VA_ARGS__, POGO_SLIP_DECLARED, POGO_SLIP_PLAIN, )(__VA_ARGS__)
#define POGO_SLIP_PICK(descriptor, data, size, declared, chosen, ...) chosen
#define POGO_SLIP_PLAIN(descriptor, data, size) POGO_SLIP_DECLARED(descriptor, data, size, -1)
#ifdef REAL_ROBOT
// In firmware for the emulated processor, always with four arguments.
#define POGO_SLIP_DECLARED(descriptor, data, size, declared) \
    (slip_send_message)((descriptor), (data), (size), (declared))
#else
#define POGO_SLIP_DECLARED(descriptor, data, size, declared) \
    ((slip_error_t)pogosim_send_packet((descriptor), (data), (size), (declared)))
#endif
#define slip_send_init(descriptor) ((void)(descriptor), SLIP_NO_ERROR)

#ifdef __cplusplus
extern "C" {
#endif
#ifdef REAL_ROBOT
// `declared_length`: of the payload; -1: as its header says.
slip_error_t(slip_send_message)(slip_send_descriptor_s const* descriptor, uint8_t const* data, uint32_t size,
                                int32_t declared_length);
#else
int pogosim_send_packet(void const* descriptor, uint8_t const* data, uint32_t size, int64_t declared_length);
#endif
slip_error_t slip_receive_init(slip_receive_state_s* state) POGO_NOT_SIMULATED;
slip_error_t slip_decode_received_byte(slip_receive_state_s* state, uint8_t byte) POGO_NOT_SIMULATED;
void slip_dump_state(slip_receive_state_s* state, char* message) POGO_NOT_SIMULATED;
void slip_reset_error_counter(slip_receive_state_s* state)
    POGO_NOT_SIMULATED_BECAUSE("call pogobot_infrared_reset_receiver_error_counter()");
#ifdef __cplusplus
}
#endif

#endif
