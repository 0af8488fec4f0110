// Robots with devices and without any program.
#pragma once

#include <cstdint>

#include "device/set_up.hpp"
#include "support/small_world.hpp"

namespace pogosim::testing {

/// A robot in the middle of a square metre, heading to the right.
inline World world_with_robot(ObjectSpec const& spec = pogobot_spec(), std::uint64_t seed = 1) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F, spec);
    set_up_devices(world, seed);
    return world;
}

/// The same with another queue for messages.
inline World world_with_queue(int queue_size) {
    ObjectSpec spec = pogobot_spec();
    spec.robot->ir.queue_size = queue_size;
    return world_with_robot(spec);
}

}  // namespace pogosim::testing
