// pogolib/flash.h
#include "device/flash.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"

using pogosim::context;
using pogosim::NoteSlip;
using pogosim::require_argument;
using pogosim::require_robot;

namespace {

/// Once for each category.
void note_lost_bits(std::uint16_t page) {
    context.services->warn_once_of(
        {.text = "was not erased", .function = "write_page_flash", .argument = get_current_robot_category()},
        "write_page_flash(): page {} was not erased before, and a write only clears bits (flash: nor), so the page "
        "does not contain what was written; call erase_write_section_flash() first, which erases all pages",
        page);
}

}  // namespace

void read_page_flash(uint16_t page, char* buf) {
    require_robot(__func__);
    require_argument(buf, __func__, "buf");
    if (pogosim::is_flash_page(pogosim::own_model(), page, "nothing is read", NoteSlip{__func__})) {
        pogosim::read_page(context.devices().flash[context.device], page, reinterpret_cast<std::byte*>(buf));
    }
}

void write_page_flash(uint16_t page, void const* data) {
    require_robot(__func__);
    require_argument(data, __func__, "data");
    if (!pogosim::is_flash_page(pogosim::own_model(), page, "nothing is written", NoteSlip{__func__})) {
        return;
    }
    if (!pogosim::write_page(*context.world, context.device, page, static_cast<std::byte const*>(data))) {
        note_lost_bits(page);
    }
}

void erase_write_section_flash() {
    require_robot(__func__);
    pogosim::erase(context.devices().flash[context.device]);
}
