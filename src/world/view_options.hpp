// What pictures of a world show: in the window, in frames, films and what Python draws. The section `view` of a
// configuration, see config/view_keys.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace pogosim {

enum class LinkLayer { hidden, below, above };
enum class Theme { dark, light };
enum class PaletteKind { standard, color_blind };

struct ViewOptions {
    bool time = true;
    bool scale_bar = true;
    LinkLayer links = LinkLayer::hidden;  // infrared: which robots can hear each other
    bool lateral_leds = true;
    bool light_levels = false;
    bool trails = false;
    bool labels = false;      // ids of robots
    bool velocities = false;  // arrows to where they would be a second later
    bool heard = false;       // which robots heard which in the last second
    std::string color_by{};   // a value of robots, see RobotValues; empty: the colour of the head LED
    std::string heat_map{};   // likewise, or "density"; empty: none
    Theme theme = Theme::dark;
    PaletteKind palette = PaletteKind::standard;
    std::optional<std::uint32_t> follow{};          // id of the robot in the middle; absent: the whole arena is shown
    double zoom = 1.0;                              // times the size at which the arena fills the picture
    double history_s = 30.0;                        // the window goes back by so much
    std::string pause_when{};                       // the window pauses when this is true of a robot; empty: never
    std::optional<std::uint32_t> selected_robot{};  // index; gets a mark around it

    friend bool operator==(ViewOptions const&, ViewOptions const&) = default;
};

/// The heat map of where robots are.
inline constexpr char const* kDensity = "density";

}  // namespace pogosim
