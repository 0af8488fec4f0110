// The formations `lloyd` and `power_lloyd`. S. P. Lloyd, "Least squares quantization in PCM", IEEE Trans. Inf. Theory
// 28(2), 129-137, 1982: move every site to the centroid of its cell, again and again. The cells are taken over a fixed
// set of points drawn uniformly in the arena.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "base/grid.hpp"
#include "geometry/formations/disk_field.hpp"
#include "geometry/formations/separation.hpp"
#include "geometry/formations/task.hpp"

namespace pogosim {

namespace {

// Power diagram of weighted sites: each point belongs to the site of least squared distance less weight. With equal
// weights it is the Voronoi diagram. F. Aurenhammer, "Power diagrams: properties, algorithms and applications", SIAM J.
// Comput. 16(1), 78-96, 1987.

class PowerDiagram {
public:
    /// A site's weight is its radius squared, so that the border of two touching disks runs through their contact.
    PowerDiagram(Box bounds_mm, std::span<float const> radii_mm);

    void set_sites(std::span<Vec2 const> sites_mm);

    /// The site whose cell the point, within the bounds, is in. The first of equals.
    std::uint32_t cell_of(Vec2 point_mm) const;

private:
    struct Layer {
        SizeClass sizes;
        UniformGrid grid;  // of the members
    };

    Box bounds_mm_;
    std::vector<Layer> layers_;
    std::vector<float> weights_;
};

PowerDiagram::PowerDiagram(Box bounds_mm, std::span<float const> radii_mm) : bounds_mm_(bounds_mm) {
    for (float const radius : radii_mm) {
        weights_.push_back(radius * radius);
    }
    for (SizeClass& sizes : size_classes(radii_mm)) {
        layers_.push_back({std::move(sizes), UniformGrid()});
    }
}

void PowerDiagram::set_sites(std::span<Vec2 const> sites_mm) {
    for (Layer& layer : layers_) {
        std::vector<Vec2> members_mm;
        for (std::uint32_t const site : layer.sizes.members) {
            members_mm.push_back(sites_mm[site]);
        }
        layer.grid.build(members_mm, bounds_mm_, spacing_mm(bounds_mm_, members_mm.size()), /*periodic=*/false);
    }
}

std::uint32_t PowerDiagram::cell_of(Vec2 point_mm) const {
    std::pair<float, std::uint32_t> best{std::numeric_limits<float>::infinity(), 0};  // power, site
    for (Layer const& layer : layers_) {
        float const largest_weight = layer.sizes.largest * layer.sizes.largest;
        layer.grid.search_outwards(
            point_mm,
            [&](std::uint32_t member, Vec2 place) {
                std::uint32_t const site = layer.sizes.members[member];
                best = std::min(best, {squared_length(place - point_mm) - weights_[site], site});
            },
            [&](float gap_mm) { return gap_mm * gap_mm - largest_weight > best.first; });
    }
    return best.second;
}

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
float move_to_centroids(PowerDiagram& diagram, std::span<Vec2 const> samples, std::vector<Vec2>& sites,
                        RandomStream& random) {
    diagram.set_sites(sites);
    struct Cell {
        double x = 0.0;
        double y = 0.0;
        std::size_t count = 0;
    };
    std::vector<Cell> cells(sites.size());
    for (Vec2 const sample : samples) {
        Cell& cell = cells[diagram.cell_of(sample)];
        cell.x += sample.x;
        cell.y += sample.y;
        ++cell.count;
    }
    float farthest = 0.0F;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        Cell const& cell = cells[i];
        auto const count = static_cast<double>(cell.count);
        Vec2 const place = cell.count > 0 ? Vec2{static_cast<float>(cell.x / count), static_cast<float>(cell.y / count)}
                                          : samples[random.below(static_cast<std::uint32_t>(samples.size()))];
        farthest = std::max(farthest, length(place - sites[i]));
        sites[i] = place;
    }
    return farthest;
}

std::vector<Vec2> spread(PlacementTask const& task, std::span<Vec2 const> samples, std::span<float const> weights_mm,
                         int iterations) {
    std::vector<Vec2> sites(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(task.radii_mm.size()));
    PowerDiagram diagram(task.domain.bounds, weights_mm);
    float const still_mm = kStill * length(task.domain.bounds.size());
    for (int i = 0; i < iterations && move_to_centroids(diagram, samples, sites, task.random) > still_mm; ++i) {
    }
    return sites;
}

std::vector<Placement> place_evenly(PlacementTask const& task, std::span<float const> weights_mm,
                                    LloydSettings const& settings) {
    std::size_t const samples_wanted = std::max(settings.samples, kSamplesPerObject * task.radii_mm.size());
    for (int start = 0; start < kStarts; ++start) {
        std::vector<Vec2> const samples = draw_samples(task, samples_wanted);
        std::vector<Vec2> places = spread(task, samples, weights_mm, settings.iterations);
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
