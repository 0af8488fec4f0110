#include "view/switches.hpp"

#include <SDL.h>

#include <string_view>
#include <type_traits>

namespace pogosim {

namespace {

/// Whether any of these is on.
template <bool ViewOptions::*... members>
int is_any_on(ViewOptions const& options) {
    return ((options.*members) || ...) ? 1 : 0;
}

template <bool ViewOptions::*... members>
void set_all(ViewOptions& options, int choice) {
    ((options.*members = choice != 0), ...);
}

/// A choice of an enumeration whose values are 0, 1, 2, ...
template <auto member>
int get_choice(ViewOptions const& options) {
    return static_cast<int>(options.*member);
}

template <auto member>
void set_choice(ViewOptions& options, int choice) {
    options.*member = static_cast<std::remove_reference_t<decltype(options.*member)>>(choice);
}

using O = ViewOptions;

constexpr std::array kLayers{
    Switch{.key = SDLK_F2,
           .key_name = "F2",
           .effect = "trails",
           .label = "trails",
           .get = is_any_on<&O::trails>,
           .set = set_all<&O::trails>},
    Switch{.key = SDLK_F5,
           .key_name = "F5",
           .effect = "links between robots that hear each other: off, below, above the robots",
           .label = "links",
           .choices = "off\0below\0above\0",
           .get = get_choice<&O::links>,
           .set = set_choice<&O::links>},
    Switch{.key = SDLK_F6,
           .key_name = "F6",
           .effect = "lateral LEDs",
           .label = "lateral LEDs",
           .get = is_any_on<&O::lateral_leds>,
           .set = set_all<&O::lateral_leds>},
    Switch{.key = SDLK_F7,
           .key_name = "F7",
           .effect = "light levels",
           .label = "light levels",
           .get = is_any_on<&O::light_levels>,
           .set = set_all<&O::light_levels>},
    Switch{.key = SDLK_F8,
           .key_name = "F8",
           .effect = "time and scale bar",
           .label = "time and scale bar",
           .get = is_any_on<&O::time, &O::scale_bar>,
           .set = set_all<&O::time, &O::scale_bar>},
};

constexpr std::array kMarks{
    Switch{.key = SDLK_l,
           .key_name = "L",
           .effect = "labels of robots",
           .label = "labels",
           .get = is_any_on<&O::labels>,
           .set = set_all<&O::labels>},
    Switch{.key = SDLK_v,
           .key_name = "V",
           .effect = "velocities",
           .label = "velocities",
           .is_beside = true,
           .get = is_any_on<&O::velocities>,
           .set = set_all<&O::velocities>},
    Switch{.key = SDLK_h,
           .key_name = "H",
           .effect = "messages heard in the last second",
           .label = "messages heard",
           .get = is_any_on<&O::heard>,
           .set = set_all<&O::heard>},
    Switch{.key = SDLK_d,
           .key_name = "D",
           .effect = "heat map of the density of robots",  // in the panel one of several heat maps
           .get = [](O const& options) { return options.heat_map.empty() ? 0 : 1; },
           .set = [](O& options, int choice) { options.heat_map = choice != 0 ? kDensity : ""; }},
};

constexpr std::array kColours{
    Switch{.key = SDLK_t,
           .key_name = "T",
           .effect = "dark or light",
           .label = "light theme",
           .get = get_choice<&O::theme>,
           .set = set_choice<&O::theme>},
    Switch{.label = "colour-blind", .is_beside = true, .get = get_choice<&O::palette>, .set = set_choice<&O::palette>},
};

}  // namespace

int Switch::choice_count() const {
    if (choices == nullptr) {
        return 2;
    }
    int count = 0;
    for (std::string_view name = choices; !name.empty(); name = name.data() + name.size() + 1) {
        ++count;
    }
    return count;
}

void Switch::press(ViewOptions& options) const {
    set(options, (get(options) + 1) % choice_count());
}

std::span<Switch const> layer_switches() {
    return kLayers;
}

std::span<Switch const> mark_switches() {
    return kMarks;
}

std::span<Switch const> colour_switches() {
    return kColours;
}

Switch const* switch_of(std::int32_t key) {
    for (std::span<Switch const> const group : all_switches()) {
        for (Switch const& one : group) {
            if (one.key == key && key != 0) {
                return &one;
            }
        }
    }
    return nullptr;
}

}  // namespace pogosim
