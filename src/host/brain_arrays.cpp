// The arrays that drive the robots of a category, where they are.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "brain/host_brain.hpp"
#include "config/values.hpp"
#include "host/array_places.hpp"
#include "host/hosted_run.hpp"
#include "host/status.hpp"

using namespace pogosim;

namespace {

using Received = HostBrain::Received;

pogosim_array received(std::span<Received const> messages) {
    return described(messages.data(), "<i4", {static_cast<std::int64_t>(messages.size()), 5},
                     {sizeof(Received), sizeof(std::int32_t)});
}

pogosim_array bytes(std::span<std::byte const> values) {
    return described(values.data(), "|u1", {static_cast<std::int64_t>(values.size())}, {1});
}

struct NamedArray {
    std::string_view name;
    pogosim_array (*describe)(HostBrain& brain);
};
constexpr std::array kArrays{
    NamedArray{"motors", [](HostBrain& b) { return table<std::int32_t>(b.inputs().motors); }},
    NamedArray{"leds", [](HostBrain& b) { return leds(b.inputs().leds); }},
    NamedArray{"send_bytes", [](HostBrain& b) { return table<std::uint8_t>(b.inputs().send_bytes); }},
    NamedArray{"send_length", [](HostBrain& b) { return numbers(b.inputs().send_length); }},
    NamedArray{"send_face", [](HostBrain& b) { return numbers(b.inputs().send_face); }},
    NamedArray{"photosensors", [](HostBrain& b) { return table<std::int16_t>(b.outputs().photosensors); }},
    NamedArray{"acceleration", [](HostBrain& b) { return table<float>(b.outputs().acceleration); }},
    NamedArray{"angular_velocity", [](HostBrain& b) { return table<float>(b.outputs().angular_velocity); }},
    NamedArray{"battery_mv", [](HostBrain& b) { return numbers(b.outputs().battery_mv); }},
    NamedArray{"received_count", [](HostBrain& b) { return numbers(b.outputs().received_count); }},
    NamedArray{"received", [](HostBrain& b) { return received(b.received()); }},
    NamedArray{"received_bytes", [](HostBrain& b) { return bytes(b.received_bytes()); }},
};

/// Categories with such a brain, each once, as a message names them.
std::string categories_of_host(pogosim_run& run) {
    std::vector<std::string> names;
    for (Category const& category : run.simulation().world().categories) {
        bool const is_known = std::ranges::find(names, category.name) != names.end();
        if (!is_known && run.simulation().host_brain(category.name) != nullptr) {
            names.push_back(category.name);
        }
    }
    return names.empty() ? "no category has 'brain: host'" : fmt::format("a host drives {}", fmt::join(names, ", "));
}

/// Throws ConfigError.
HostBrain& brain_of(pogosim_run& run, std::string_view category) {
    if (HostBrain* const found = run.simulation().host_brain(category)) {
        return *found;
    }
    World const& world = run.simulation().world();
    bool const is_known = std::ranges::find(world.categories, category, &Category::name) != world.categories.end();
    throw ConfigError(
        is_known ? fmt::format("category '{}' is not driven by the host: its configuration needs 'brain: host'; {}",
                               category, categories_of_host(run))
                 : fmt::format("there is no category '{}'{}; {}", shown(category),
                               world.periodic ? " (walls are not created in a periodic arena)" : "",
                               categories_of_host(run)));
}

}  // namespace

pogosim_array pogosim::brain_array_of(pogosim_run& run, std::string_view category, std::string_view name) {
    HostBrain& brain = brain_of(run, category);
    auto const* const found = std::ranges::find(kArrays, name, &NamedArray::name);
    if (found == kArrays.end()) {
        throw ConfigError(fmt::format("a brain has no array '{}'", name));
    }
    return found->describe(brain);
}

int pogosim_run_brain_array(pogosim_run* run, char const* category, char const* name, pogosim_array* array) {
    return with_status_of(*run, [&] {
        if (category == nullptr || name == nullptr) {
            throw ConfigError("expected the names of a category and of an array, found NULL");
        }
        *array = brain_array_of(*run, category, name);
        return POGOSIM_OK;
    });
}

int pogosim_run_clear_received(pogosim_run* run, char const* category) {
    return with_status_of(*run, [&] {
        if (category == nullptr) {
            throw ConfigError("expected the name of a category, found NULL");
        }
        brain_of(*run, category).clear_received();
        return POGOSIM_OK;
    });
}
