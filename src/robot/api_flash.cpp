// pogolib/flash.h
#include "robot/context.hpp"
#include "robot/flash.hpp"
#include "robot/require_robot.hpp"
#include "robot/slip.hpp"

using pogosim::context;
using pogosim::require_argument;
using pogosim::require_robot;

namespace {

bool is_page(char const* function, std::uint16_t page, char const* outcome) {
    bool const known = page < pogosim::kFlashPageCount;
    if (!known) [[unlikely]] {
        pogosim::note_slip({function, "page", "0 to 5887 (POGOBOT_USER_FLASH_PAGE_COUNT - 1)", outcome}, page);
    }
    return known;
}

}  // namespace

void read_page_flash(uint16_t page, char* buf) {
    require_robot(__func__);
    require_argument(buf, __func__, "buf");
    if (is_page(__func__, page, "nothing is read")) {
        pogosim::read_page(context.controller->flash, page, reinterpret_cast<std::byte*>(buf));
    }
}

void write_page_flash(uint16_t page, void const* data) {
    require_robot(__func__);
    require_argument(data, __func__, "data");
    if (!is_page(__func__, page, "nothing is written")) {
        return;
    }
    pogosim::overwrite_page(context.controller->flash, page, static_cast<std::byte const*>(data));
}

void erase_write_section_flash() {
    require_robot(__func__);
    pogosim::erase(context.controller->flash);
}
