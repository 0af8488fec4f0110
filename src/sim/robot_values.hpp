// Values of all robots at one time by their names, for colours and heat maps of pictures, and for breakpoints.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/scenario.hpp"
#include "sim/saved_columns.hpp"
#include "world/data_table.hpp"
#include "world/world.hpp"

namespace pogosim {

/// What is known of a value by its name alone.
struct ValueInfo {
    std::string_view unit{};  // empty: it has none, or it is of the program
    bool is_angle = false;    // rad
};
ValueInfo value_info(std::string_view name);

class RobotValues {
public:
    /// References outlive this. `columns`: what robots gave at the last save.
    RobotValues(World const& world, SavedColumns const& columns) : world_(world), columns_(columns) {}

    /// Those that the world knows: speed (mm/s, in the last step), x, y (mm), angle (rad), light (sensor counts); then
    /// the program's columns that hold numbers.
    std::vector<std::string> names() const;

    std::size_t robot_count() const { return world_.robots.size(); }

    /// Shape: (robots,); NaN where there is none. All are NaN for an unknown name.
    std::vector<float> of(std::string_view name) const;

    /// The same into an array of any size, whose memory is used again.
    void read(std::string_view name, std::vector<float>& values) const;

private:
    World const& world_;
    SavedColumns const& columns_;
};

/// Whether pictures may need columns of the program, for colours or a heat map. A window always keeps them.
bool needs_columns(ViewOptions const& options);

/// Throws ConfigError if the section `view` names a value or a robot that does not exist, or its pause_when cannot be
/// read. Call it once the columns of the program are known.
void check_shown_values(Scenario const& scenario, World const& world, std::span<ColumnSpec const> columns);

}  // namespace pogosim
