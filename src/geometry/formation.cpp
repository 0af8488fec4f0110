#include "geometry/formation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>

#include "base/nearest_name.hpp"
#include "base/number_from.hpp"
#include "geometry/formations/task.hpp"

namespace pogosim {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kCommonHeading = 0.5F * kPi;
constexpr double kShareTolerance = 0.02;  // of an estimated part of the area

struct Formation {
    std::string name;
    std::vector<Placement> (*place)(PlacementTask const&);
    bool aligned;
};

std::array<Formation, 13> const& formations() {
    static std::array<Formation, 13> const table{{
        {"random", place_random, false},
        {"aligned_random", place_random, true},
        {"random_near_walls", place_near_walls, false},
        {"aligned_random_near_walls", place_near_walls, true},
        {"disk", place_disk, false},
        {"aligned_disk", place_disk, true},
        {"lloyd", place_lloyd, false},
        {"power_lloyd", place_power_lloyd, false},
        {"chessboard", place_chessboard, false},
        {"aligned_chessboard", place_chessboard, true},
        {"lattice", place_lattice, false},
        {"aligned_lattice", place_lattice, true},
        {"imported", place_imported, false},
    }};
    return table;
}

Formation const& formation_named(std::string const& name) {
    auto const found = std::ranges::find(formations(), name, &Formation::name);
    if (found != formations().end()) {
        return *found;
    }
    std::string const nearest = nearest_name(name, formation_names());
    throw FormationError(kFormationKey,
                         fmt::format("unknown formation '{}'. {}", name,
                                     nearest.empty() ? fmt::format("Known: {}", fmt::join(formation_names(), ", "))
                                                     : fmt::format("Did you mean '{}'?", nearest)));
}

void check_spec(FormationSpec const& spec) {
    struct Rule {
        char const* key;
        bool holds;
        char const* expected;
        double found;
    };
    Rule const rules[] = {
        {"formation_min_space_between_neighbors", std::isfinite(spec.min_space_mm) && spec.min_space_mm >= 0.0F,
         "a finite length >= 0 mm", spec.min_space_mm},
        {"formation_max_space_between_neighbors", spec.max_space_mm > 0.0F, "a length > 0 mm", spec.max_space_mm},
        {"formation_attempts_per_point", spec.attempts_per_point >= 1, "a count >= 1",
         static_cast<double>(spec.attempts_per_point)},
        {"formation_max_restarts", spec.max_restarts >= 0, "a count >= 0", static_cast<double>(spec.max_restarts)},
        {"chessboard_distance_between_neighbors",
         std::isfinite(spec.chessboard_pitch_mm) && spec.chessboard_pitch_mm > 0.0F, "a finite length > 0 mm",
         spec.chessboard_pitch_mm},
        {kLatticeSpacingKey,
         !spec.lattice_spacing_mm || (std::isfinite(*spec.lattice_spacing_mm) && *spec.lattice_spacing_mm > 0.0F),
         "a finite length > 0 mm", spec.lattice_spacing_mm.value_or(0.0F)},
    };
    for (Rule const& rule : rules) {
        if (!rule.holds) {
            throw FormationError(rule.key, fmt::format("expected {}, found {:g}", rule.expected, rule.found));
        }
    }
}

std::vector<float> placement_radii(FormationSpec const& spec, std::span<float const> radii_mm) {
    std::vector<float> placed;
    for (float const radius : radii_mm) {
        assert(std::isfinite(radius) && radius >= 0.0F);
        placed.push_back(kPlacementMargin * std::max(radius, spec.min_space_mm));
    }
    return placed;
}

std::string area_text(double area_mm2) {
    return area_mm2 >= 100.0 ? fmt::format("{:.0f} mm2", area_mm2) : fmt::format("{:.3g} mm2", area_mm2);
}

/// The two digits that an estimate is good for.
double estimated(double value) {
    return number_from(fmt::format("{:.2g}", value));
}

/// No arrangement of disks covers more than all that is free.
void check_area(PlacementTask const& task) {
    double covered = 0.0;
    for (float const radius : task.radii_mm) {
        covered += std::numbers::pi * radius * radius;
    }
    double const share = task.space.free_share();
    bool const alone = share == 1.0;
    double const free_mm2 = share * task.domain.area_mm2;
    if (covered > (alone ? free_mm2 : free_mm2 + kShareTolerance * task.domain.area_mm2)) {
        std::string const room =
            alone ? fmt::format("the {} is only {}", task.ground, area_text(free_mm2))
                  : fmt::format("only about {} of the {} is free", area_text(estimated(free_mm2)), task.ground);
        throw FormationError(
            kFormationKey, fmt::format("'{}' cannot place {}: they need {} including spacing, but {}; reduce nb or {}",
                                       task.spec.name, describe_objects(task), area_text(covered), room, task.remedy));
    }
}

/// Uniform in (-pi, pi].
float random_heading(RandomStream& random) {
    return wrap_angle(-random.uniform(-kPi, kPi));
}

}  // namespace

bool is_lattice(std::string_view name) {
    auto const found = std::ranges::find(formations(), name, &Formation::name);
    return found != formations().end() && found->place == place_lattice;
}

float lattice_spacing_of(FormationSpec const& spec, std::span<float const> radii_mm) {
    std::vector<float> const placed = placement_radii(spec, radii_mm);
    float const largest_mm = placed.empty() ? 0.0F : *std::ranges::max_element(placed);
    return lattice_spacing(spec, largest_mm);
}

std::span<std::string const> formation_names() {
    static std::vector<std::string> const names = [] {
        std::vector<std::string> all;
        std::ranges::transform(formations(), std::back_inserter(all), &Formation::name);
        return all;
    }();
    return names;
}

std::vector<Placement> place(FormationSpec const& spec, std::span<float const> radii_mm, FormationGround const& ground,
                             RandomStream& random, PoseReader const& read_feather) {
    Formation const& formation = formation_named(spec.name);
    check_spec(spec);
    if (radii_mm.empty()) {
        return {};
    }
    std::vector<float> const radii = placement_radii(spec, radii_mm);
    FreeSpace const space(ground.domain, ground.obstacles);
    PlacementTask const task{spec,   radii,        ground.domain, ground.obstacles, space,
                             random, read_feather, ground.name,   ground.remedy,    ground.periodic};
    if (formation.place != place_imported) {
        check_area(task);
    }
    std::vector<Placement> placements = formation.place(task);
    for (Placement& placement : placements) {
        if (std::isnan(placement.heading_rad)) {
            placement.heading_rad = formation.aligned ? kCommonHeading : random_heading(random);
        }
    }
    return placements;
}

}  // namespace pogosim
