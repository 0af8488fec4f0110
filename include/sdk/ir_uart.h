/// @file
/// The serial lines of the infrared receivers, which are not simulated: messages arrive whole.
#ifndef POGOSIM_SDK_IR_UART_H
#define POGOSIM_SDK_IR_UART_H

#include "pogosim_hardware.h"

#ifdef __cplusplus
extern "C" {
#endif
void ir_uart_init(void) POGO_NOT_SIMULATED;
void ir_uart_sync(void) POGO_NOT_SIMULATED;
void ir_uart_write(char c) POGO_NOT_SIMULATED;
int ir_uart_read_nonblock(uint8_t receiver) POGO_NOT_SIMULATED;
char ir_uart_read(uint8_t receiver) POGO_NOT_SIMULATED;
uint32_t ir_uart_rx_drop_count(uint8_t receiver)
    POGO_NOT_SIMULATED_BECAUSE("bytes are not simulated: pogobot_infrared_get_queue_drop_count() counts messages");
void ir_uart_tx_isr(void) POGO_NOT_SIMULATED;
void ir_uart_rx_isr(void) POGO_NOT_SIMULATED;
#ifdef __cplusplus
}
#endif

#endif
