/// @file
/// The infrared hardware, which is not simulated below the messages of pogobot.h.
#ifndef POGOSIM_SDK_POGOBOT_IR_H
#define POGOSIM_SDK_POGOBOT_IR_H

#include "pogosim_hardware.h"

typedef uint8_t ir_uart_word_t;

#ifdef __cplusplus
extern "C" {
#endif
uint8_t ir_init(void) POGO_NOT_SIMULATED_BECAUSE("call pogobot_infrared_ll_init()");
uint8_t IRn_tx_write_msg(uint8_t mask, ir_uart_word_t* msg, size_t length) POGO_NOT_SIMULATED_BECAUSE(
    "emitters are not simulated below the level of messages: call a function such as "
    "pogobot_infrared_sendRawLongMessage()");
void IRn_conf_tx_power_write(int index, int power) POGO_NOT_SIMULATED_BECAUSE("call pogobot_infrared_set_power()");
void IRn_conf_d_oe(uint8_t id, uint8_t val, uint32_t* old) POGO_NOT_SIMULATED;
void IRn_conf_e_oe(uint8_t id, uint8_t val, uint32_t* old) POGO_NOT_SIMULATED;
void IRn_conf_d_w(uint8_t id, uint8_t val, uint32_t* old) POGO_NOT_SIMULATED;
void IRn_conf_e_w(uint8_t id, uint8_t val, uint32_t* old) POGO_NOT_SIMULATED;
#ifdef __cplusplus
}
#endif

#endif
