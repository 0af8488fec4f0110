#include "sim/snapshot_taker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "device/infrared.hpp"
#include "render/snapshot.hpp"
#include "world/link_places.hpp"
#include "world/observed_motion.hpp"
#include "world/world.hpp"

namespace pogosim {

namespace {

// Links between bodies, for pictures.

constexpr float kLeastTensionN = 1e-6F;  // that is shown: rounding is not

/// The largest tension of all links that do not break.
float largest_tension_n(std::vector<Link> const& links) {
    float largest_n = 0.0F;
    for (Link const& link : links) {
        if (!link.is_cut && !std::isfinite(link.breaking_n)) {
            largest_n = std::max(largest_n, std::abs(link.tension_n));
        }
    }
    return largest_n;
}

/// The links that hold, of categories that are drawn. `from_mm` is in the box of a periodic arena.
std::vector<BodyLink> drawn_links(World const& world) {
    std::vector<BodyLink> drawn;
    float const largest_n = std::max(largest_tension_n(world.links), kLeastTensionN);
    for (Link const& link : world.links) {
        if (link.is_cut || !world.link_categories[link.link_category].are_drawn) {
            continue;
        }
        LinkPlaces const ends = places_of_ends(world, link);
        Vec2 const from_mm = wrapped(world, ends.a_mm);
        drawn.push_back({.kind = link.kind,
                         .is_pinned = link.b == kNone,
                         .from_mm = from_mm,
                         .to_mm = from_mm + ends.span_mm(),
                         .load = link.tension_n / (std::isfinite(link.breaking_n) ? link.breaking_n : largest_n)});
    }
    return drawn;
}

}  // namespace

SnapshotTaker::SnapshotTaker(World const& world, Lighting const& lighting, SavedColumns const& columns)
    : world_(world),
      lighting_(lighting),
      scenery_(std::make_shared<Scenery const>(make_scenery(world))),
      values_(world, columns) {}

std::optional<RobotColumn> SnapshotTaker::column(std::string const& name) {
    if (name.empty()) {
        return std::nullopt;
    }
    ValueInfo const value = value_info(name);
    RobotColumn column{
        .name = name, .unit = std::string(value.unit), .is_angle = value.is_angle, .values = values_.of(name)};
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();
    auto& [low, high] = ranges_.try_emplace(name, kInfinite, -kInfinite).first->second;
    for (float const number : column.values) {
        if (std::isfinite(number)) {
            low = std::min(low, number);
            high = std::max(high, number);
        }
    }
    column.low = low <= high ? low : kNoValue;
    column.high = low <= high ? high : kNoValue;
    return column;
}

Snapshot SnapshotTaker::take(SnapshotParts const& parts) {
    Bodies const& bodies = world_.bodies;
    Snapshot snapshot{.scenery = scenery_,
                      .step = world_.step,
                      .time_s = world_.time_s(),
                      .position_mm = bodies.position_mm,
                      .heading_rad = bodies.heading_rad,
                      .led = world_.robots.led,
                      .lamps = lighting_.marks(),
                      .light = parts.light ? light() : nullptr,
                      .links = {},
                      .trails = parts.trails ? std::make_shared<Trails const>(trails_) : nullptr,
                      .body_links = drawn_links(world_),
                      .color_by = column(parts.color_by),
                      .heat_map = column(parts.heat_map)};
    if (parts.velocities) {
        for (std::uint32_t body = 0; body < bodies.size(); ++body) {
            snapshot.velocity_mm_s.push_back(observed_motion(world_, body).velocity_mm_s);
        }
    }
    if (parts.heard && heard_ != nullptr) {
        snapshot.heard = heard_->until(snapshot.time_s);
    }
    if (world_.periodic) {
        std::ranges::transform(bodies.position_mm, snapshot.position_mm.begin(),
                               [this](Vec2 position_mm) { return wrapped(world_, position_mm); });
        for (LampMark& lamp : snapshot.lamps) {
            lamp.centre_mm = wrapped(world_, lamp.centre_mm);
            lamp.shape_mm = wrapped(world_, lamp.shape_mm);
        }
    }
    if (parts.links) {
        range_mm_.clear();
        for (std::uint32_t robot = 0; robot < world_.robots.size(); ++robot) {
            range_mm_.push_back(ir_range_mm(world_, robot));
        }
        snapshot.links = link_finder_.find(world_, range_mm_);
    }
    return snapshot;
}

std::shared_ptr<LightMap const> SnapshotTaker::light() {
    if (!light_ || light_->level != world_.light.level) {
        light_ = std::make_shared<LightMap const>(world_.light);
    }
    return light_;
}

void SnapshotTaker::follow_trails() {
    trails_.follow(world_);
}

}  // namespace pogosim
