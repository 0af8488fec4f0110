// What callbacks of the whole run (pogosim/world.h) and hosts (pogosim/host.h) may change between two steps, with what
// both have to check. Robots are switched off by set_alive(), switched_off.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "device/switched_off.hpp"
#include "world/world.hpp"

namespace pogosim {

struct WorldEdit {
    std::function<bool(Object const& object, Vec2 centre_mm)> is_free{};  // of walls
    std::function<void()> update_light{};                                 // takes the settings of lamps over
    bool light_is_stale = false;                                          // a setting or a shadow has changed since

    /// Moves an object to another pose, at rest. Returns false, and leaves it, if it has no body, or if the place is in
    /// a wall or outside of the arena.
    bool set_pose(World& world, Object const& object, Vec2 centre_mm, float heading_rad);

    /// The light follows at the next step, or with settle_light().
    void set_lamp(World& world, std::size_t lamp, LampSetting const& setting);

    /// Computes the light by the present settings of the lamps.
    void settle_light();
};

/// The setting of a lamp that is moved to a place.
LampSetting moved_to(PlacedLamp const& lamp, Vec2 place_mm);

}  // namespace pogosim
