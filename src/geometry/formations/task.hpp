// What every formation is given, and the formations. Each returns one placement per object. There is at least one
// object.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/formation.hpp"
#include "geometry/formations/free_space.hpp"

namespace pogosim {

/// Stands for a heading that is still to be drawn.
constexpr float kHeadingToDraw = std::numeric_limits<float>::quiet_NaN();

/// A placement radius is this much larger than the object.
constexpr float kPlacementMargin = 1.01F;

struct PlacementTask {
    FormationSpec const& spec;
    std::span<float const> radii_mm;  // placement radii
    Arena const& domain;
    std::span<Obstacle const> obstacles;
    FreeSpace const& space;  // the domain less the obstacles
    RandomStream& random;
    PoseReader const& read_feather;
    std::string_view ground = "arena";  // what messages call the domain
    std::string_view remedy = "enlarge arena_surface";
    bool periodic = false;  // all of the domain's bounding box is inside
};

/// Random sequential addition: each object at a uniform random place where it fits. B. Widom, "Random sequential
/// addition of hard spheres to a volume", J. Chem. Phys. 44, 3888, 1966. Equal disks cover at most 54.7 % so.
std::vector<Placement> place_random(PlacementTask const& task);

/// Along the walls while there is room, then in layers that touch what is already placed.
std::vector<Placement> place_near_walls(PlacementTask const& task);

/// Compact: on concentric rings around the centre.
std::vector<Placement> place_disk(PlacementTask const& task);

/// On a square grid: compact around the centre, or spread over the bounding box.
std::vector<Placement> place_chessboard(PlacementTask const& task);

/// On the nodes of a triangular or a square lattice: a compact patch around the centre.
std::vector<Placement> place_lattice(PlacementTask const& task);

constexpr char const* kLatticeSpacingKey = "lattice_distance_between_neighbors";

/// Distance between neighbours of a lattice of objects, the largest of which has this placement radius.
float lattice_spacing(FormationSpec const& spec, float largest_mm);

/// Evenly spread: the centroidal Voronoi diagram, sampled.
std::vector<Placement> place_lloyd(PlacementTask const& task);

/// Evenly spread, larger objects with more room: the centroidal power diagram, sampled.
std::vector<Placement> place_power_lloyd(PlacementTask const& task);

/// Where a file says.
std::vector<Placement> place_imported(PlacementTask const& task);

/// The objects, largest first; equal ones in their order.
std::vector<std::uint32_t> largest_first(std::span<float const> radii_mm);

/// Points that a formation draws at random at most, so that a hopeless request ends within seconds.
constexpr std::int64_t kMostPointsDrawn = 20'000'000;

/// Calls try_once, which returns how many objects it placed, until that is all of them. Throws ConfigError after
/// `max_restarts`, or when `points_drawn`, which try_once increases, has reached its limit.
void repeat_until_all_stand(PlacementTask const& task, std::int64_t const& points_drawn,
                            std::function<std::size_t()> const& try_once);

/// Start of a message about objects that do not fit: "40 objects (largest radius 26.5 mm)".
std::string describe_objects(PlacementTask const& task);

/// `centre_mm` of the spec; where it is NaN, the centroid of the outer polygon. Throws ConfigError when it is not
/// within the bounding box.
Vec2 formation_centre(PlacementTask const& task);

}  // namespace pogosim
