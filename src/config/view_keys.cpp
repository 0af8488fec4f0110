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
        K{"labels", &ViewOptions::labels, any(), "", "The ids of robots."},
        K{"velocities", &ViewOptions::velocities, any(), "",
          "Arrows to where bodies would be a second later, as they moved in the last step."},
        K{"heard", &ViewOptions::heard, any(), "",
          "Arrows from senders to robots that got a message of theirs in the last second; older ones are fainter."},
        K{"color_by", &ViewOptions::color_by, any(), "",
          "A value that colours robots in place of their head LEDs: speed (mm/s), x, y, angle, light, or a column of "
          "the program that holds numbers. Colours go from the lowest to the highest value so far. Empty: none."},
        K{"heat_map", &ViewOptions::heat_map, any(), "",
          "density: robots per square metre on the floor, smoothed over 4 % of the longer side; or a value, as for "
          "color_by: its mean among the robots nearby. Empty: none."},
        K{"theme", one_of(&ViewOptions::theme, {{"dark", Theme::dark}, {"light", Theme::light}}), any(), "",
          "Colours of floor, walls and lines: dark, or light for slides and print."},
        K{"palette",
          one_of(&ViewOptions::palette,
                 {{"standard", PaletteKind::standard}, {"color_blind", PaletteKind::color_blind}}),
          any(), "",
          "color_blind: hues of LEDs and links that are distinct with any colour vision (Okabe and Ito, 2008)."},
        K{"follow", &ViewOptions::follow, any(), "",
          "Id of a robot that stays in the middle; if omitted, the arena does."},
        K{"zoom", &ViewOptions::zoom, between(0.1, 100), "", "Size of what is shown; 1: the arena fills the picture."},
        K{"history", &ViewOptions::history_s, between(0, 3600), "s",
          "Simulated time that the window keeps, to look at it again."},
        K{"pause_when", &ViewOptions::pause_when, any(), "",
          "The window pauses when this becomes true of a robot: values, as for color_by, numbers, + - * /, "
          "comparisons, and, or, not, such as \"speed < 1 and heard > 10\". Looked at after every step; columns of "
          "the program have the values of the last row. Empty: never."},
    };
    return keys;
}

}  // namespace

void read_view_map(MapReader& reader, ViewOptions& options) {
    reader.read(view_option_keys(), options);
}

std::string view_as_yaml(ViewOptions const& options) {
    static Node const nothing;
    Reading reading;
    MapReader map(nothing, "view", reading);
    ViewOptions same = options;
    read_view_map(map, same);
    return to_yaml(map.values());
}

ViewOptions view_from_yaml(std::string const& yaml) {
    Node const tree = parse_yaml(yaml, "view");
    Reading reading;
    MapReader map(tree, "view", reading);
    ViewOptions options;
    read_view_map(map, options);
    map.finish();
    reading.problems.throw_if_any();
    return options;
}

}  // namespace pogosim
