// The world as arrays, where it is.
#include <fmt/format.h>

#include <array>
#include <string_view>
#include <vector>

#include "host/array_places.hpp"
#include "host/hosted_run.hpp"

namespace pogosim {

namespace {

pogosim_array vectors(std::vector<Vec2> const& values) {
    static_assert(sizeof(Vec2) == 2 * sizeof(float));
    return described(values.data(), "<f4", {static_cast<std::int64_t>(values.size()), 2},
                     {sizeof(Vec2), sizeof(float)});
}

/// One value of each robot, without that of callback_global_step.
template <class T>
pogosim_array of_robots(std::vector<T> const& values) {
    pogosim_array array = numbers(values);
    --array.shape[0];
    return array;
}

/// A member of each robot's magnetometer.
template <class T>
pogosim_array of_magnetometers(std::vector<Magnetometer> const& all, T const& of_first) {
    return described(&of_first, type_of<T>(), {static_cast<std::int64_t>(all.size()) - 1}, {sizeof(Magnetometer)});
}

pogosim_array magnetometers(std::vector<Magnetometer> const& all) {
    auto const& of_first = all.front();
    pogosim_array array = of_magnetometers(all, of_first.last.front());
    array.dimensions = 2;
    array.shape[1] = kAxisCount;
    array.stride_bytes[1] = sizeof(of_first.last.front());
    return array;
}

pogosim_array user_data(Simulation const& simulation) {
    Controllers const& controllers = simulation.controllers();
    auto const all = controllers.all();
    return described(all.empty() ? nullptr : all.front().user_data, fmt::format("|V{}", controllers.user_data_bytes()),
                     {static_cast<std::int64_t>(all.size())},
                     {static_cast<std::int64_t>(controllers.user_data_stride())});
}

pogosim_array light(LightMap const& map) {
    return described(map.level.data(), "<i2", {map.rows, map.columns},
                     {static_cast<std::int64_t>(sizeof(std::int16_t)) * map.columns, sizeof(std::int16_t)});
}

struct NamedArray {
    std::string_view name;
    pogosim_array (*describe)(Simulation const& simulation);
};
constexpr std::array kArrays{
    NamedArray{"bodies.position", [](Simulation const& s) { return vectors(s.world().bodies.position_mm); }},
    NamedArray{"bodies.heading", [](Simulation const& s) { return numbers(s.world().bodies.heading_rad); }},
    NamedArray{"bodies.velocity", [](Simulation const& s) { return vectors(s.observed_motions().velocity_mm_s()); }},
    NamedArray{"bodies.angular_velocity",
               [](Simulation const& s) { return numbers(s.observed_motions().angular_velocity_rad_s()); }},
    NamedArray{"bodies.radius", [](Simulation const& s) { return numbers(s.world().bodies.radius_mm); }},
    NamedArray{"robots.id", [](Simulation const& s) { return numbers(s.world().robots.id); }},
    NamedArray{"robots.category", [](Simulation const& s) { return numbers(s.world().robots.category); }},
    NamedArray{"robots.body", [](Simulation const& s) { return numbers(s.world().robots.body); }},
    NamedArray{"robots.led", [](Simulation const& s) { return leds(s.world().robots.led); }},
    NamedArray{"robots.ticks", [](Simulation const& s) { return of_robots(s.world().devices.ticks); }},
    NamedArray{"robots.clock", [](Simulation const& s) { return of_robots(s.world().devices.clock_us); }},
    NamedArray{"robots.messages_sent", [](Simulation const& s) { return of_robots(s.world().devices.messages_sent); }},
    NamedArray{"robots.messages_received",
               [](Simulation const& s) { return of_robots(s.world().devices.messages_received); }},
    NamedArray{"robots.magnetometer",
               [](Simulation const& s) { return magnetometers(s.world().devices.magnetometer); }},
    NamedArray{"robots.magnetometer_samples",
               [](Simulation const& s) {
                   auto const& all = s.world().devices.magnetometer;
                   return of_magnetometers(all, all.front().samples);
               }},
    NamedArray{"robots.user_data", user_data},
    NamedArray{"light", [](Simulation const& s) { return light(s.world().light); }},
};

}  // namespace

std::optional<pogosim_array> array_of(Simulation const& simulation, std::string_view name) {
    for (NamedArray const& array : kArrays) {
        if (array.name == name) {
            return array.describe(simulation);
        }
    }
    return column_array_of(simulation.saved_columns(), name);
}

}  // namespace pogosim
