#include "config/configuration_text.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>
#include <vector>

#include "config/source.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

void set(Node& map, std::string_view key, Node value) {
    if (Node* const found = map.find(key)) {
        *found = std::move(value);
    } else {
        map.entries.emplace_back(std::string(key), std::move(value));
    }
}

}  // namespace

ConfigurationText configuration_text(Scenario const& scenario, RunValues const& run) {
    // Only the seed is taken from the command line: the bytes are the same with or without window or progress bar, and
    // with any number of threads.
    Node written = source_of(scenario).tree;
    Node resolved = source_of(scenario).values;
    for (Node* const configuration : {&written, &resolved}) {
        configuration->kind = Node::Kind::map;
        set(*configuration, "seed", value_node(run.seed));
        set(*configuration, "GUI", value_node(scenario.view.gui));
        set(*configuration, "progress_bar", value_node(false));
        set(*configuration, "mm_to_pixels", plain_node(fmt::format("{}", run.mm_to_pixels)));
        std::erase_if(configuration->entries, [](auto const& entry) { return entry.key == "threads"; });
    }
    set(resolved, "time_step", plain_node(fmt::format("{}", run.time_step_s)));
    set(resolved, "physics_engine", plain_node(run.physics_engine));
    if (run.is_periodic) {
        set(resolved, "boundary_condition", plain_node("periodic"));
        std::erase_if(resolved.entries, [](auto const& entry) { return entry.key.starts_with("wall_"); });
    }
    return {.written = to_yaml(written), .resolved = to_yaml(resolved)};
}

}  // namespace pogosim
