#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "geometry/formations/ring_placement.hpp"

namespace pogosim {

namespace {

constexpr float kPitchTolerance = 0.08F;  // by which the spread grid may differ from the pitch asked for
constexpr int kPitchSteps = 16;           // tried on either side
// Of a grid, so that a hopeless request ends soon: so many, or so many for each object.
constexpr double kMostNodes = 1.0e6;
constexpr double kMostNodesPerObject = 4.0;

std::string remedy(PlacementTask const& task) {
    return fmt::format("reduce nb, lower chessboard_distance_between_neighbors, or {}", task.remedy);
}

/// Squares of grid nodes around the centre; of each, those nearest to the centre first.
RingPattern squares(Vec2 centre, float pitch_mm) {
    auto const nodes = [centre, pitch_mm](int ring) {
        std::vector<Vec2> places;
        for (int j = -ring; j <= ring; ++j) {
            int const stride = std::abs(j) == ring ? 1 : 2 * ring;
            for (int i = -ring; i <= ring; i += std::max(stride, 1)) {
                places.push_back({static_cast<float>(i), static_cast<float>(j)});
            }
        }
        std::ranges::stable_sort(places, {}, squared_length);
        std::ranges::for_each(places, [&](Vec2& place) { place = centre + pitch_mm * place; });
        return places;
    };
    return {pitch_mm, nodes};
}

[[noreturn]] void refuse(PlacementTask const& task, std::string const& reason) {
    throw FormationError(kFormationKey,
                         fmt::format("'{}' cannot place {}: {}", task.spec.name, describe_objects(task), reason));
}

/// Nodes, row after row, of the grid that is centred in the bounding box, as far as an object of this radius fits.
std::vector<Vec2> usable_nodes(PlacementTask const& task, float pitch_mm, float radius_mm) {
    Vec2 const size = task.domain.bounds.size();
    auto const columns = static_cast<int>(size.x / pitch_mm) + 1;
    auto const rows = static_cast<int>(size.y / pitch_mm) + 1;
    Vec2 const span = pitch_mm * Vec2{static_cast<float>(columns - 1), static_cast<float>(rows - 1)};
    Vec2 const first = task.domain.bounds.min + 0.5F * (size - span);
    std::vector<Vec2> nodes;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            Vec2 const node = first + pitch_mm * Vec2{static_cast<float>(i), static_cast<float>(j)};
            if (task.space.holds(node, radius_mm)) {
                nodes.push_back(node);
            }
        }
    }
    return nodes;
}

/// The nodes of the grid with as many of them as there are objects, of a pitch as near as possible to the one asked
/// for; without one, those of the grid with too many whose pitch is nearest.
std::vector<Vec2> best_grid(PlacementTask const& task) {
    float const largest_mm = *std::ranges::max_element(task.radii_mm);
    std::size_t const wanted = task.radii_mm.size();
    std::size_t most = 0;
    std::vector<Vec2> enough;
    for (int k = 0; k <= 2 * kPitchSteps; ++k) {
        // 0, -1, 1, -2, 2, ... steps from the pitch asked for
        int const steps = k % 2 == 0 ? k / 2 : -(k + 1) / 2;
        float const change = kPitchTolerance * static_cast<float>(steps) / static_cast<float>(kPitchSteps);
        float const pitch_mm = task.spec.chessboard_pitch_mm * (1.0F + change);
        if (pitch_mm < 2.0F * largest_mm) {
            continue;
        }
        std::vector<Vec2> nodes = usable_nodes(task, pitch_mm, largest_mm);
        most = std::max(most, nodes.size());
        if (nodes.size() == wanted) {
            return nodes;
        }
        if (nodes.size() > wanted && enough.empty()) {
            enough = std::move(nodes);
        }
    }
    if (enough.empty()) {
        refuse(task, fmt::format("a grid of pitch {:g} mm (+-8 %) has at most {} places in this {}; {}",
                                 task.spec.chessboard_pitch_mm, most, task.ground, remedy(task)));
    }
    return enough;
}

std::vector<Placement> place_spread(PlacementTask const& task) {
    std::vector<Vec2> const nodes = best_grid(task);
    std::size_t const count = task.radii_mm.size();
    std::vector<Placement> placements;
    for (std::size_t i = 0; i < count; ++i) {
        placements.push_back({nodes[i * nodes.size() / count], kHeadingToDraw});
    }
    return placements;
}

void check_pitch(PlacementTask const& task, float radius_mm) {
    if (task.spec.chessboard_pitch_mm < 2.0F * radius_mm) {
        refuse(task, fmt::format("chessboard_distance_between_neighbors is {:g} mm and must be at least {:.4g} mm",
                                 task.spec.chessboard_pitch_mm, 2.0F * radius_mm));
    }
    Vec2 const size = task.domain.bounds.size();
    double const pitch_mm = task.spec.chessboard_pitch_mm;
    double const most = std::max(kMostNodes, kMostNodesPerObject * static_cast<double>(task.radii_mm.size()));
    if (static_cast<double>(size.x) * size.y / (pitch_mm * pitch_mm) > most) {
        refuse(task, fmt::format("chessboard_distance_between_neighbors of {:g} mm makes more than {:.0f} places",
                                 task.spec.chessboard_pitch_mm, most));
    }
}

}  // namespace

std::vector<Placement> place_chessboard(PlacementTask const& task) {
    // In rings around the centre, objects larger than the pitch take the place of several nodes; a spread grid has
    // none.
    auto const [smallest, largest] = std::ranges::minmax(task.radii_mm);
    check_pitch(task, task.spec.cluster_at_centre ? smallest : largest);
    if (!task.spec.cluster_at_centre) {
        return place_spread(task);
    }
    Vec2 const centre = formation_centre(task);
    auto const pattern_for = [&](float) { return squares(centre, task.spec.chessboard_pitch_mm); };
    return place_on_rings(task, centre, pattern_for, remedy(task));
}

}  // namespace pogosim
