// Heat maps: the density of robots, or the mean of a value, as colours of the floor.
#pragma once

#include <memory>
#include <vector>

#include "render/colour_key.hpp"
#include "render/heat_field.hpp"
#include "render/scene.hpp"

namespace pogosim {

/// Keeps the field that it drew last: a run that is paused needs no other one. NaN equals nothing, so a column with a
/// robot without a value is computed each time.
class HeatLayer {
public:
    /// Draws the density of robots, or the mean of a column. Returns what its colours mean.
    ColourKey draw(Scene const& scene);

private:
    bool is_up_to_date(Snapshot const& snapshot) const;
    void update(Snapshot const& snapshot);

    HeatField field_;
    // What it was computed of.
    std::shared_ptr<Scenery const> scenery_;
    std::vector<Vec2> position_mm_;
    bool is_density_ = false;
    std::vector<float> values_;
    bool is_angle_ = false;
};

}  // namespace pogosim
