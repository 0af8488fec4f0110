#include "sim/robot_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "base/utf8.hpp"
#include "config/places.hpp"
#include "sim/condition.hpp"
#include "world/observed_motion.hpp"

namespace pogosim {

namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

/// What the world knows of a body.
struct BodyValue {
    std::string_view name;
    ValueInfo known;
    float (*value)(World const& world, std::uint32_t body);
};

constexpr std::array kBodyValues{
    BodyValue{
        "speed",
        {.unit = "mm/s"},
        [](World const& world, std::uint32_t body) { return length(observed_motion(world, body).velocity_mm_s); }},
    BodyValue{"x",
              {.unit = "mm"},
              [](World const& world, std::uint32_t body) { return wrapped(world, world.bodies.position_mm[body]).x; }},
    BodyValue{"y",
              {.unit = "mm"},
              [](World const& world, std::uint32_t body) { return wrapped(world, world.bodies.position_mm[body]).y; }},
    BodyValue{"angle",
              {.unit = "rad", .is_angle = true},
              [](World const& world, std::uint32_t body) { return wrap_angle(world.bodies.heading_rad[body]); }},
    BodyValue{"light",
              {},
              [](World const& world, std::uint32_t body) {
                  return static_cast<float>(world.light.at(wrapped(world, world.bodies.position_mm[body])));
              }},
};

std::vector<std::string> names_of_world() {
    std::vector<std::string> names;
    for (BodyValue const& own : kBodyValues) {
        names.emplace_back(own.name);
    }
    return names;
}

std::string_view note_on_columns(Scenario const& scenario) {
    return scenario.output.enable_data_logging ? "" : " (columns of the program need enable_data_logging: true)";
}

void check_value(Scenario const& scenario, Setting setting, std::string const& name,
                 std::vector<std::string> const& known) {
    if (!name.empty() && std::ranges::find(known, name) == known.end()) {
        throw ConfigError(fmt::format("{}: the robots have no value '{}'; expected one of {}{}{}",
                                      place_of(scenario, setting), name, fmt::join(known, ", "),
                                      note_on_columns(scenario), did_you_mean(name, known)));
    }
}

void check_condition(Scenario const& scenario, std::vector<std::string> const& known) {
    if (scenario.view.pause_when.empty()) {
        return;
    }
    try {
        Condition const readable(scenario.view.pause_when, known);
    } catch (ConfigError const& error) {
        throw ConfigError(
            fmt::format("{}: {}{}", place_of(scenario, Setting::pause_when), error.what(), note_on_columns(scenario)));
    }
}

}  // namespace

std::vector<std::string> RobotValues::names() const {
    std::vector<std::string> names = names_of_world();
    for (SavedColumn const& column : columns_.columns()) {
        if (column.type != ColumnType::text && std::ranges::find(names, column.name) == names.end()) {
            names.push_back(column.name);
        }
    }
    return names;
}

ValueInfo value_info(std::string_view name) {
    auto const of_body = std::ranges::find(kBodyValues, name, &BodyValue::name);
    return of_body != kBodyValues.end() ? of_body->known : ValueInfo{};
}

std::vector<float> RobotValues::of(std::string_view name) const {
    std::vector<float> values;
    read(name, values);
    return values;
}

void RobotValues::read(std::string_view name, std::vector<float>& values) const {
    values.assign(world_.robots.size(), kNoValue);
    auto const of_body = std::ranges::find(kBodyValues, name, &BodyValue::name);
    if (of_body != kBodyValues.end()) {
        for (std::size_t robot = 0; robot < values.size(); ++robot) {
            std::uint32_t const body = world_.robots.body[robot];
            values[robot] = body == kNone ? kNoValue : of_body->value(world_, body);
        }
        return;
    }
    auto const column = std::ranges::find(columns_.columns(), name, &SavedColumn::name);
    if (column != columns_.columns().end() && column->type != ColumnType::text) {
        ColumnTypeRow const& type = row_of(column->type);
        for (std::size_t robot = 0; robot < values.size(); ++robot) {
            std::byte const* const place = column->values.data() + robot * type.bytes;
            values[robot] = column->is_absent[robot] != 0 ? kNoValue : static_cast<float>(type.read(place));
        }
    }
}

bool needs_columns(ViewOptions const& options) {
    return !options.color_by.empty() || (!options.heat_map.empty() && options.heat_map != kDensity);
}

void check_shown_values(Scenario const& scenario, World const& world, std::span<ColumnSpec const> columns) {
    std::vector<std::string> known = names_of_world();
    for (ColumnSpec const& column : columns) {
        if (column.type != ColumnType::text) {
            known.push_back(replace_malformed(column.name));
        }
    }
    check_value(scenario, Setting::color_by, scenario.view.color_by, known);
    check_condition(scenario, known);
    known.insert(known.begin(), kDensity);
    check_value(scenario, Setting::heat_map, scenario.view.heat_map, known);
    std::optional<std::uint32_t> const& followed = scenario.view.follow;
    if (followed && std::ranges::find(world.robots.id, *followed) == world.robots.id.end()) {
        throw ConfigError(fmt::format("{}: there is no robot {}", place_of(scenario, Setting::follow), *followed));
    }
}

}  // namespace pogosim
