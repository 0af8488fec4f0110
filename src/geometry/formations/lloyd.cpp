// The formations `lloyd` and `power_lloyd`. S. P. Lloyd, "Least squares quantization in PCM", IEEE Trans. Inf. Theory
// 28(2), 129-137, 1982: move every site to the centroid of its cell, again and again. The cells are taken over a fixed
// set of points drawn uniformly in the arena.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include "geometry/formations/power_cells.hpp"
#include "geometry/formations/separation.hpp"
#include "geometry/formations/task.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kSamplesPerObject = 16;  // at least, so that many objects have cells too
constexpr float kStill = 1.0e-3F;              // movement, relative to the arena's size, that counts as none
constexpr int kStarts = 2;                     // arrangements tried before giving up

struct LloydSettings {
    std::size_t samples;
    int iterations;
};

/// Uniform in the arena.
std::vector<Vec2> draw_samples(PlacementTask const& task, std::size_t count) {
    std::vector<Vec2> samples;
    for (std::int64_t drawn = 0; samples.size() < count && drawn < kMostPointsDrawn; ++drawn) {
        Vec2 const point = task.space.random_point(task.random);
        if (task.space.holds(point, 0.0F)) {
            samples.push_back(point);
        }
    }
    if (samples.size() < task.radii_mm.size()) {
        throw FormationError(kFormationKey, fmt::format("'{}' cannot place {}: the {} is too thin to draw points in it",
                                                        task.spec.name, describe_objects(task), task.ground));
    }
    return samples;
}

/// Moves every site to the centroid of its cell, and a site without a cell to a random sample. Returns the largest
/// distance moved.
float move_to_centroids(std::span<PointSum const> cells, std::span<Vec2 const> samples, std::vector<Vec2>& sites,
                        RandomStream& random) {
    float farthest = 0.0F;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        PointSum const& cell = cells[i];
        auto const count = static_cast<double>(cell.count);
        Vec2 const place = cell.count > 0
                               ? Vec2{static_cast<float>(cell.x_mm / count), static_cast<float>(cell.y_mm / count)}
                               : samples[random.below(static_cast<std::uint32_t>(samples.size()))];
        farthest = std::max(farthest, length(place - sites[i]));
        sites[i] = place;
    }
    return farthest;
}

/// A site's weight is its radius squared, so that the border of two touching disks runs through their contact.
std::vector<Vec2> spread(PlacementTask const& task, std::span<Vec2 const> samples, std::span<float const> radii_mm,
                         int iterations) {
    std::vector<Vec2> sites(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(task.radii_mm.size()));
    std::vector<float> weights_mm2;
    std::ranges::transform(radii_mm, std::back_inserter(weights_mm2), [](float radius) { return radius * radius; });
    PowerCells const cells(task.domain.bounds, samples);
    float const still_mm = kStill * length(task.domain.bounds.size());
    for (int i = 0; i < iterations; ++i) {
        if (move_to_centroids(cells.sums(sites, weights_mm2), samples, sites, task.random) <= still_mm) {
            break;
        }
    }
    return sites;
}

std::vector<Placement> place_evenly(PlacementTask const& task, std::span<float const> radii_mm,
                                    LloydSettings const& settings) {
    std::size_t const samples_wanted = std::max(settings.samples, kSamplesPerObject * task.radii_mm.size());
    for (int start = 0; start < kStarts; ++start) {
        std::vector<Vec2> const samples = draw_samples(task, samples_wanted);
        std::vector<Vec2> places = spread(task, samples, radii_mm, settings.iterations);
        if (separate(task, places, samples)) {
            std::vector<Placement> placements;
            std::ranges::transform(places, std::back_inserter(placements), [](Vec2 p) {
                return Placement{p, kHeadingToDraw};
            });
            return placements;
        }
    }
    throw FormationError(
        kFormationKey,
        fmt::format("'{}' found no arrangement of {} in this {} that keeps them apart and clear of the walls; "
                    "reduce nb or {}",
                    task.spec.name, describe_objects(task), task.ground, task.remedy));
}

}  // namespace

std::vector<Placement> place_lloyd(PlacementTask const& task) {
    std::vector<float> const equal(task.radii_mm.size(), 0.0F);
    return place_evenly(task, equal, {.samples = 20000, .iterations = 20});
}

std::vector<Placement> place_power_lloyd(PlacementTask const& task) {
    return place_evenly(task, task.radii_mm, {.samples = 25000, .iterations = 25});
}

}  // namespace pogosim
