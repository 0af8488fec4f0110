#include <array>
#include <span>

#include "config/scenario_keys.hpp"

namespace pogosim {

namespace {

std::span<Key<ViewOptions> const> view_option_keys() {
    using K = Key<ViewOptions>;
    static std::array const keys{
        K{"time", &ViewOptions::time, any(), "", "The time, at the top right."},
        K{"scale_bar", &ViewOptions::scale_bar, any(), "", "A bar of a round length, at the bottom left."},
        K{"links",
          one_of(&ViewOptions::links,
                 {{"hidden", LinkLayer::hidden}, {"below", LinkLayer::below}, {"above", LinkLayer::above}}),
          any(), "", "Which robots can hear each other: lines below the robots, or above them."},
        K{"lateral_LEDs", &ViewOptions::lateral_leds, any(), "", "LEDs 1 to 4."},
        K{"light_levels", &ViewOptions::light_levels, any(), "", "The floor is brighter where there is more light."},
        K{"trails", &ViewOptions::trails, any(), "", "Where robots have been."},
    };
    return keys;
}

}  // namespace

void read_view_map(MapReader& reader, ViewOptions& options) {
    reader.read(view_option_keys(), options);
}

}  // namespace pogosim
