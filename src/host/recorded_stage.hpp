// What stands still in a recorded run, as pogosim/painter.h describes it.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "geometry/shape.hpp"
#include "pogosim/painter.h"
#include "render/snapshot.hpp"
#include "world/view_options.hpp"

namespace pogosim {

struct RecordedStage {
    std::shared_ptr<Scenery const> scenery;  // objects that run a program are robots, in this order
    ViewOptions view;
    bool shows_leds = true;  // colours are LEDs
    int light_columns = 1;
    int light_rows = 1;
    std::vector<Shape> lamps;
};

/// Throws ConfigError for a description or an array that is wrong.
RecordedStage read_stage(pogosim_stage const& stage);

}  // namespace pogosim
