// The user's section of flash memory, for a firmware.
#include "device/flash.hpp"

#include <array>
#include <cstdint>

#include "device/arguments.hpp"
#include "firmware/firmware_call.hpp"

namespace pogosim {

namespace {

CallOutcome read_user_page(FirmwareCall& call) {
    std::uint16_t const page = call.half(0);
    if (is_flash_page(call.model(), page, "nothing is read", call)) {
        FlashPage bytes{};
        read_page(call.world.devices.flash[call.robot], page, bytes.data());
        call.write(call.argument(1), bytes);
    }
    return CallOutcome::returns;
}

CallOutcome write_user_page(FirmwareCall& call) {
    std::uint16_t const page = call.half(0);
    if (!is_flash_page(call.model(), page, "nothing is written", call)) {
        return CallOutcome::returns;
    }
    FlashPage bytes{};
    call.read(call.argument(1), bytes);
    if (!write_page(call.world, call.robot, page, bytes.data())) {
        call.note_slip({"page", "one that was erased before, since a write only clears bits (flash: nor)",
                        "it does not contain what was written; call erase_write_section_flash() first"},
                       page);
    }
    return CallOutcome::returns;
}

CallOutcome erase_user_section(FirmwareCall& call) {
    erase(call.world.devices.flash[call.robot]);
    return CallOutcome::returns;
}

}  // namespace

std::span<LibraryFunction const> flash_functions() {
    static std::array const functions{
        LibraryFunction{"read_page_flash", read_user_page, &CallTimes::flash_read_us},
        LibraryFunction{"write_page_flash", write_user_page, &CallTimes::flash_write_us},
        LibraryFunction{"erase_write_section_flash", erase_user_section, &CallTimes::flash_erase_us},
    };
    return functions;
}

}  // namespace pogosim
