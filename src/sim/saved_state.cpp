#include "sim/saved_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <string>

#include "base/error.hpp"
#include "base/state_bytes.hpp"
#include "sim/simulation.hpp"
#include "world/saved_world.hpp"

namespace pogosim {

/// Rows, messages and pictures would go back in time.
std::string Simulation::why_not_saved() const {
    if (recorder_.row_count()) {
        return "it writes a data file (enable_data_logging: false)";
    }
    if (!scenario_.output.message_log.empty()) {
        return "it writes a log of messages (message_log)";
    }
    if (pictures_) {
        return "it saves pictures (save_video_period: -1)";
    }
    if (observer_) {
        return "its firmware is profiled, or looked at by gdb";
    }
    for (auto const& brain : brains_) {
        if (std::string reason = brain->why_not_saved(); !reason.empty()) {
            return reason;
        }
    }
    return "";
}

std::unique_ptr<SavedState> Simulation::save() {
    Thread const thread(*this);
    if (std::string const reason = why_not_saved(); !reason.empty()) {
        throw ConfigError(fmt::format("the state of this run cannot be saved: {}", reason));
    }
    auto physics = physics_->copy();
    if (!physics) {
        throw ConfigError(fmt::format("the state of this run cannot be saved: its physics engine ({}) cannot be copied",
                                      physics_engine_behind(scenario_.physics_engine)));
    }
    auto saved = std::make_unique<SavedState>(SavedState{.world = world_,
                                                         .lighting = lighting_,
                                                         .physics = std::move(physics),
                                                         .broken_links = broken_links_,
                                                         .brains = {},
                                                         .stop_requested = services_.stop_requested});
    for (auto const& brain : brains_) {
        saved->brains.push_back(brain->save());
    }
    return saved;
}

std::size_t bytes_of(SavedState const& saved) {
    StateWriter changed;
    append_world(saved.world, changed);
    saved.physics->append_state(changed);
    std::size_t const levels = saved.world.light.level.size() * sizeof(saved.world.light.level[0]);
    std::size_t bytes = sizeof(SavedState) + changed.bytes().size() + levels;
    for (auto const& brain : saved.brains) {
        bytes += brain->byte_count();
    }
    return bytes;
}

void Simulation::restore(SavedState const& saved) {
    Thread const thread(*this);
    assert(saved.brains.size() == brains_.size());
    world_ = saved.world;
    lighting_ = saved.lighting;
    physics_ = saved.physics->copy();
    broken_links_ = saved.broken_links;
    for (std::size_t i = 0; i < brains_.size(); ++i) {
        brains_[i]->restore(*saved.brains[i]);
    }
    services_.stop_requested = saved.stop_requested;
    if (observed_motions_) {
        observed_motions_->update(world_);
    }
    forget_what_was_seen();
}

void Simulation::forget_what_was_seen() {
    if (heard_) {
        heard_->clear();
    }
    if (snapshots_) {
        snapshots_->forget();
    }
    if (inspector_) {
        inspector_->forget();
    }
}

}  // namespace pogosim
