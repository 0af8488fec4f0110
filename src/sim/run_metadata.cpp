#include "sim/run_metadata.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pogosim/version.h"

namespace pogosim {

namespace {

constexpr float kFitMargin = 0.95F;  // of the window that the arena fills

Node scalar(std::string text) {
    Node node;
    node.kind = Node::Kind::scalar;
    node.scalar = std::move(text);
    return node;
}

void set(Node& map, std::string const& key, std::string text) {
    if (Node* const found = map.find(key)) {
        *found = scalar(std::move(text));
    } else {
        map.entries.emplace_back(key, scalar(std::move(text)));
    }
}

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
                                                              RunValues const& run) {
    // Nothing from the command line but the seed: with or without window or progress bar, the bytes are the same.
    Node written = scenario.resolved;
    Node resolved = scenario.values;
    for (Node* const configuration : {&written, &resolved}) {
        set(*configuration, "seed", std::to_string(run.seed));
        set(*configuration, "GUI", scenario.view.gui ? "true" : "false");
        set(*configuration, "progress_bar", "false");
        set(*configuration, "mm_to_pixels", fmt::format("{}", fitted_mm_to_pixels(scenario.view, arena)));
    }
    set(resolved, "time_step", fmt::format("{}", run.time_step_s));
    set(resolved, "physics_engine", run.physics_engine);
    if (run.is_periodic) {
        set(resolved, "boundary_condition", "periodic");
        std::erase_if(resolved.entries, [](auto const& entry) { return entry.key.starts_with("wall_"); });
    }
    return {{"program_version", POGOSIM_VERSION_STRING},
            {"configuration", to_yaml(written)},
            {"resolved_configuration", to_yaml(resolved)},
            {"arena_polygons", polygons_as_yaml(arena)}};
}

}  // namespace pogosim
