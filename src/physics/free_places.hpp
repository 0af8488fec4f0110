// Where objects can be put without standing in a wall.
#pragma once

#include "geometry/wall_index.hpp"
#include "world/world.hpp"

namespace pogosim {

/// A place is free for an object when the centre of each of its bodies is inside the arena, and no wall comes nearer to
/// it than its inner radius (give or take 1 %). Other objects do not count: the engine pushes them apart. In a periodic
/// world every place is free. Objects without a body have no free place but their own.
class FreePlaces {
public:
    explicit FreePlaces(World const& world) : world_(world), walls_(world.arena) {}

    /// `centre_mm`: of the object, as centre_mm().
    bool is_free(Object const& object, Vec2 centre_mm) const;

    /// `target_mm` if that is free. Otherwise the place that the object reaches on its way there from its present
    /// place, if it slides along walls; if that is not free either, its present place.
    Vec2 nearest(Object const& object, Vec2 target_mm) const;

private:
    Vec2 slide(Object const& object, Vec2 motion_mm) const;

    World const& world_;
    WallIndex walls_;
};

}  // namespace pogosim
