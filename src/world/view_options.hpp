// What pictures of a world show: in the window, in frames, films and what Python draws. The section `view` of a
// configuration, see config/view_keys.cpp.
#pragma once

#include <cstdint>
#include <optional>

namespace pogosim {

enum class LinkLayer { hidden, below, above };

struct ViewOptions {
    bool time = true;
    bool scale_bar = true;
    LinkLayer links = LinkLayer::hidden;  // infrared: who can hear whom
    bool lateral_leds = true;
    bool light_levels = false;
    bool trails = false;
    std::optional<std::uint32_t> selected_robot{};  // index; gets a mark around it

    friend bool operator==(ViewOptions const&, ViewOptions const&) = default;
};

}  // namespace pogosim
