// Which colours stand for which values, and how that is told in a picture.
#pragma once

#include <span>
#include <string>

#include "render/scene.hpp"
#include "render/snapshot.hpp"
#include "render/text.hpp"
#include "render/theme_colours.hpp"

namespace pogosim {

/// From values to colours.
struct ValueScale {
    float low = 0.0F;
    float high = 1.0F;
    bool is_angle = false;  // rad: `low` and `high` have the same colour

    /// From 0, `low`, to 1, `high`. Where the range is empty, a half.
    float share(float value) const;

    Pixel colour(ThemeColours const& colours, float share) const;
};

/// The range of the column; of an angle, one turn.
ValueScale scale_of(RobotColumn const& column);

/// A scale, and what a picture writes beside it.
struct ColourKey {
    std::string name;
    ValueScale scale;
};

/// With the unit of the value.
ColourKey key_of(RobotColumn const& column);

/// Bars with names and ranges, bottom right, one above the other.
void draw_keys(Scene const& scene, Text& text, std::span<ColourKey const> keys);

}  // namespace pogosim
