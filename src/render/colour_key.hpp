// Which colours stand for which values, and how that is told in a picture.
#pragma once

#include <span>
#include <string>

#include "render/colours.hpp"
#include "render/scene.hpp"
#include "render/snapshot.hpp"
#include "render/text.hpp"

namespace pogosim {

struct ColourKey {
    std::string name;
    float low = 0.0F;
    float high = 1.0F;
    bool is_angle = false;  // rad: `low` and `high` have the same colour

    /// From 0, `low`, to 1, `high`. Where the range is empty, a half.
    float share(float value) const;

    Pixel colour(Colours const& colours, float share) const;
};

ColourKey key_of(RobotColumn const& column);

/// Bars with names and ranges, bottom right, one above the other.
void draw_keys(Scene const& scene, Text& text, std::span<ColourKey const> keys);

}  // namespace pogosim
