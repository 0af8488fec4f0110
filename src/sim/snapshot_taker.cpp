#include "sim/snapshot_taker.hpp"

#include <algorithm>

#include "device/infrared.hpp"
#include "sim/body_links.hpp"

namespace pogosim {

SnapshotTaker::SnapshotTaker(World const& world, Lighting const& lighting)
    : world_(world), lighting_(lighting), scenery_(std::make_shared<Scenery const>(make_scenery(world))) {}

Snapshot SnapshotTaker::take(SnapshotParts parts) {
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
                      .body_links = drawn_links(world_)};
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
