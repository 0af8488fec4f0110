// Objects where they stand at time 0, and warnings of those that overlap.
#pragma once

#include <cstddef>
#include <vector>

#include "base/grid.hpp"
#include "config/scenario.hpp"
#include "geometry/obstacle.hpp"
#include "world/world.hpp"

namespace pogosim {

struct StandingObject {
    ObjectConfig const* object;
    Vec2 position_mm;
    float radius_mm;                  // of the disk around it
    std::vector<Obstacle> obstacles;  // its parts
};

/// An object of a tangible entry at a pose: the parts of a rigid body are solid, a membrane encloses free space.
std::vector<Obstacle> obstacles_of(ObjectConfig const& object, Placement const& pose);

/// Appends the objects of a tangible entry at these poses.
void add_standing(ObjectConfig const& object, std::vector<Placement> const& poses,
                  std::vector<StandingObject>& objects);

/// Half the thickness of an object at its thinnest, mm.
float half_thickness_mm(ObjectSpec const& spec);

struct Overlap {
    std::size_t other;  // index of a standing object
    float depth_mm;
};

/// Finds overlaps; in a periodic world across the seams, too.
class OverlapFinder {
public:
    /// Both arguments must outlive the finder.
    OverlapFinder(std::vector<StandingObject> const& objects, World const& world);

    /// Overlaps with the objects before this one, in their order.
    std::vector<Overlap> with_earlier(std::size_t object) const;

    /// How deep the object reaches into walls, mm; 0 in a periodic world, which has none.
    float into_walls_mm(std::size_t object) const;

private:
    float depth_mm(StandingObject const& one, StandingObject const& other) const;
    float depth_mm(Obstacle const& one, Obstacle const& other) const;

    std::vector<StandingObject> const& objects_;
    World const& world_;
    float largest_mm_ = 0.0F;
    UniformGrid grid_;
};

/// Warns about entries with a fixed position whose objects overlap each other or a wall deeply, naming both.
void warn_of_overlaps(Scenario const& scenario, World const& world);

/// Whether the formation `imported` places the objects of an entry.
bool is_imported(Scenario const& scenario, ObjectConfig const& object);

/// Warns once about imported objects that overlap others, and once about those that reach into a wall: physics will
/// move them away from the places in the file. `poses` are those of each entry of the scenario; `world` has all of its
/// objects.
void warn_of_imported(Scenario const& scenario, World const& world, std::vector<std::vector<Placement>> const& poses);

}  // namespace pogosim
