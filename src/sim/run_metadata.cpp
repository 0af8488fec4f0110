#include "sim/run_metadata.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pogosim/version.h"

namespace pogosim {

namespace {

constexpr float kFitMargin = 0.95F;  // of the window that the arena fills

/// Scale at which the arena fills the window, within what the window can zoom.
float fitted_mm_to_pixels(ViewConfig const& view, Arena const& arena) {
    Vec2 const size = arena.bounds.size();
    float const fit =
        std::min(static_cast<float>(view.window_width_px) / size.x, static_cast<float>(view.window_height_px) / size.y);
    return std::clamp(kFitMargin * fit, 0.1F, 10.0F);
}

std::string polygons_as_yaml(Arena const& arena) {
    std::string text;
    for (Polygon const& polygon : arena.polygons) {
        std::string separator = "- [";
        for (Vec2 const corner : polygon) {
            text += fmt::format("{}{{x: {}, y: {}}}", separator, corner.x, corner.y);
            separator = ", ";
        }
        text += "]\n";
    }
    return text;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> run_metadata(Scenario const& scenario, Arena const& arena,
                                                              RunValues run) {
    run.mm_to_pixels = fitted_mm_to_pixels(scenario.view, arena);
    ConfigurationText const text = configuration_text(scenario, run);
    return {{"program_version", POGOSIM_VERSION_STRING},
            {"configuration", text.written},
            {"resolved_configuration", text.resolved},
            {"arena_polygons", polygons_as_yaml(arena)}};
}

}  // namespace pogosim
