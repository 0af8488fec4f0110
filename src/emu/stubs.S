// The functions of the robots' library, as symbols without code: the simulator takes over at a call of one. The
// instruction itself, which no processor knows, is reached only in functions that it does not simulate.
//
// Each is in a section of its own, so that a firmware has those that it uses. tests/python/test_emu.py compares them
// with the headers.
    .macro function name
    .section .text.\name, "ax", @progbits
    .globl \name
    .type \name, @function
\name:
    unimp
    .size \name, . - \name
    .endm

// What a program may define itself.
    .macro weak_function name
    .weak \name
    function \name
    .endm

// pogosim/pogolib/flash.h
    function read_page_flash
    function write_page_flash
    function erase_write_section_flash

// pogosim/pogolib/helper.h
    function pogobot_init
    function pogobot_helper_getid
    function pogobot_helper_getRandSeed
    function pogobot_helper_print_version
    function pogobot_battery_voltage_read

// pogosim/pogolib/infrared.h
    function pogobot_infrared_sendLongMessage_omniGen
    function pogobot_infrared_sendLongMessage_omniSpe
    function pogobot_infrared_sendLongMessage_uniSpe
    function pogobot_infrared_sendShortMessage_omni
    function pogobot_infrared_sendShortMessage_uni
    function pogobot_infrared_sendRawLongMessage
    function pogobot_infrared_sendRawShortMessage
    function pogobot_infrared_set_power
    function pogobot_infrared_update
    function pogobot_infrared_message_available
    function pogobot_infrared_clear_message_queue
    function pogobot_infrared_recover_next_message
    function pogobot_infrared_get_receiver_error_counter
    function pogobot_infrared_reset_receiver_error_counter
    function pogobot_infrared_get_queue_drop_count
    function pogobot_infrared_get_malformed_count
    function pogobot_infrared_ll_init
    function is_muted
    function IR_reset_interrupt_flags

// pogosim/pogolib/leds.h
    function pogobot_led_setColor
    function pogobot_led_setColors

// pogosim/pogolib/magnetometer.h
    function magn_init
    function magn_read_XYZ
    function magn_begin
    function magn_end

// pogosim/pogolib/motors.h
    function pogobot_motor_power_set
    function pogobot_motor_set
    function pogobot_motor_dir_set
    function pogobot_motor_dir_current_status
    function pogobot_motor_dir_mem_get
    function pogobot_motor_dir_mem_set
    function pogobot_motor_power_mem_get
    function pogobot_motor_power_mem_set

// pogosim/pogolib/sensors.h
    function pogobot_photosensors_read
    function pogobot_imu_read
    function pogobot_imu_readTemp

// pogosim/pogolib/timers.h
    function pogobot_stopwatch_reset
    function pogobot_stopwatch_get_elapsed_microseconds
    function pogobot_stopwatch_lap
    function pogobot_stopwatch_offset_origin_microseconds
    function pogobot_timer_init
    function pogobot_timer_get_remaining_microseconds
    function pogobot_timer_has_expired
    function pogobot_timer_wait_for_expiry
    function pogobot_timer_offset_origin_microseconds
    function msleep
    function pli_timer_sleep_stopwatch_init

// pogosim/pogolib/timers.h: also of the C library
    weak_function usleep
    weak_function sleep

// sdk/magnetometer.h
    function magn_check

// sdk/slip.h
    function slip_send_message

// sdk/uart.h
    function uart_write

// sdk/adc.h: not simulated
    weak_function ADC_Read

// sdk/imu.h: not simulated
    weak_function IMU_GoToSleep
    weak_function IMU_ReadWord
    weak_function IMU_ReadByte
    weak_function IMU_WriteWord
    weak_function IMU_WriteByte

// sdk/ir_uart.h: not simulated
    weak_function ir_uart_init
    weak_function ir_uart_sync
    weak_function ir_uart_write
    weak_function ir_uart_read_nonblock
    weak_function ir_uart_read
    weak_function ir_uart_rx_drop_count
    weak_function ir_uart_tx_isr
    weak_function ir_uart_rx_isr

// sdk/irq.h: not simulated
    weak_function irq_getmask
    weak_function irq_setmask
    weak_function irq_pending

// sdk/pogobot_ir.h: not simulated
    weak_function ir_init
    weak_function IRn_tx_write_msg
    weak_function IRn_conf_tx_power_write
    weak_function IRn_conf_d_oe
    weak_function IRn_conf_e_oe
    weak_function IRn_conf_d_w
    weak_function IRn_conf_e_w

// sdk/rgb.h: not simulated
    weak_function color_wheel
    weak_function rgb_blink_set_time
    weak_function rgb_blink_set_color
    weak_function rgb_blink
    weak_function rgb_on_time
    weak_function rgb_off_time
    weak_function rgb_in_time
    weak_function rgb_out_time
    weak_function rgb_fixed

// sdk/slip.h: not simulated
    weak_function slip_receive_init
    weak_function slip_decode_received_byte
    weak_function slip_dump_state
    weak_function slip_reset_error_counter

// sdk/spi.h: not simulated
    weak_function spiRead
    weak_function spiWrite
    weak_function spiBeginWrite
    weak_function spiBeginErase4
    weak_function spiBeginErase32
    weak_function spiBeginErase64
    weak_function spiIsBusy
    weak_function spiId
    weak_function spiEnableQuad
    weak_function spiEraseSecurityRegister
    weak_function spiWriteSecurityRegister
    weak_function spiReadSecurityRegister
    weak_function spiInit
    weak_function spiReset
    weak_function spiPause
    weak_function spiBegin
    weak_function spiEnd
    weak_function spiFree
    weak_function spiHold
    weak_function spiUnhold
    weak_function spiSwapTxRx
    weak_function spi_single_tx
    weak_function spi_single_rx
    weak_function IMUBegin
    weak_function ADCBegin
    weak_function IMUADCEnd

// sdk/system.h: not simulated
    weak_function reboot

// sdk/ts4231.h: not simulated
    weak_function ts_waitForLight
    weak_function ts_goToSleep
    weak_function ts_goToWatch
    weak_function ts_delayUs
    weak_function ts_configDevice
    weak_function ts_writeConfig
    weak_function ts_readConfig
    weak_function ts_checkBus

// sdk/uart.h: not simulated
    weak_function uart_isr

// The C library's end of a failed assert(): the run ends with its name.
    weak_function abort
