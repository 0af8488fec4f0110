"""The functions of the robot have the types that the robots' SDK gives them."""

from __future__ import annotations

from pathlib import Path

import pytest
from running import compile_text

SEND = "uint32_t(uint8_t*, uint16_t)"
SEND_TO = "uint32_t(ir_direction, uint8_t*, uint16_t)"
STOPWATCH = "void(time_reference_t*)"
OFFSET = "void(time_reference_t*, int32_t)"
TIME = "int32_t(time_reference_t*)"

TYPES = {
    "pogobot_init": "void()",
    "pogobot_helper_getid": "uint16_t()",
    "pogobot_helper_getRandSeed": "int16_t()",
    "pogobot_helper_print_version": "void()",
    "pogobot_battery_voltage_read": "int16_t()",
    "pogobot_led_setColor": "void(uint8_t, uint8_t, uint8_t)",
    "pogobot_led_setColors": "void(uint8_t, uint8_t, uint8_t, uint8_t)",
    "pogobot_photosensors_read": "int16_t(uint8_t)",
    "pogobot_imu_read": "void(float*, float*)",
    "pogobot_imu_readTemp": "float()",
    "magn_init": "uint8_t()",
    "magn_read_XYZ": "int(int16_t*, int16_t*, int16_t*, uint16_t)",
    "magn_begin": "void()",
    "magn_end": "void()",
    "pogobot_motor_power_set": "void(motor_id, uint16_t)",
    "pogobot_motor_set": "void(motor_id, uint16_t)",
    "pogobot_motor_dir_set": "void(motor_id, uint8_t)",
    "pogobot_motor_dir_current_status": "uint32_t()",
    "pogobot_motor_dir_mem_get": "int8_t(uint8_t*)",
    "pogobot_motor_dir_mem_set": "int8_t(uint8_t*)",
    "pogobot_motor_power_mem_get": "uint8_t(uint16_t*)",
    "pogobot_motor_power_mem_set": "uint8_t(uint16_t*)",
    "read_page_flash": "void(uint16_t, char*)",
    "write_page_flash": "void(uint16_t, const void*)",
    "erase_write_section_flash": "void()",
    "pogobot_infrared_ll_init": "void()",
    "pogobot_infrared_update": "void()",
    "pogobot_infrared_message_available": "int()",
    "pogobot_infrared_recover_next_message": "void(message_t*)",
    "pogobot_infrared_clear_message_queue": "void()",
    "pogobot_infrared_set_power": "void(uint8_t)",
    "pogobot_infrared_sendRawLongMessage": "uint32_t(message_t*)",
    "pogobot_infrared_sendRawShortMessage": "uint32_t(ir_direction, short_message_t*)",
    "pogobot_infrared_sendLongMessage_uniSpe": SEND_TO,
    "pogobot_infrared_sendLongMessage_omniGen": SEND,
    "pogobot_infrared_sendLongMessage_omniSpe": SEND,
    "pogobot_infrared_sendShortMessage_uni": SEND_TO,
    "pogobot_infrared_sendShortMessage_omni": SEND,
    "pogobot_infrared_get_receiver_error_counter": "void(slip_error_counter_s*, uint8_t)",
    "pogobot_infrared_reset_receiver_error_counter": "void()",
    "pli_timer_sleep_stopwatch_init": "void()",
    "pogobot_stopwatch_reset": STOPWATCH,
    "pogobot_stopwatch_lap": TIME,
    "pogobot_stopwatch_get_elapsed_microseconds": TIME,
    "pogobot_stopwatch_offset_origin_microseconds": OFFSET,
    "pogobot_timer_init": OFFSET,
    "pogobot_timer_get_remaining_microseconds": TIME,
    "pogobot_timer_has_expired": "bool(time_reference_t*)",
    "pogobot_timer_wait_for_expiry": STOPWATCH,
    "pogobot_timer_offset_origin_microseconds": OFFSET,
    "msleep": "void(int)",
    # Those of <unistd.h>, which a program may include, too; the SDK has void(int).
    "usleep": "int(unsigned)",
    "sleep": "unsigned(unsigned)",
}


@pytest.mark.parametrize(("header", "package"), [("pogobase.h", "pogosim"), ("pogobot.h", "pogosim-sdk")])
def test_functions_have_the_types_of_the_sdk(header: str, package: str, tmp_path: Path) -> None:
    checks = "".join(
        f'static_assert(std::is_same_v<decltype({name}), {signature}>, "{name}");\n'
        for name, signature in TYPES.items()
    )
    text = f'#include "{header}"\n#include <type_traits>\n#include <unistd.h>\n{checks}int main() {{ return 0; }}\n'
    compile_text(tmp_path, text, name="main.cpp", package=package, flags=["-std=c++17", "-Wall", "-Wextra", "-Werror"])
