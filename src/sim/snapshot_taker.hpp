// Copies of the world for pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "light/lighting.hpp"
#include "render/snapshot.hpp"
#include "sim/heard_messages.hpp"
#include "sim/link_finder.hpp"
#include "sim/robot_values.hpp"
#include "world/world.hpp"

namespace pogosim {

class SnapshotTaker {
public:
    /// All references outlive this. `columns`: for values of robots that are columns of the program.
    SnapshotTaker(World const& world, Lighting const& lighting, SavedColumns const& columns);

    std::shared_ptr<Scenery const> const& scenery() const { return scenery_; }

    /// A copy of the world between two steps. Taking it changes nothing that a result depends on. Walls and membranes
    /// are included in the links; every sender counts at its present emitter power.
    Snapshot take(SnapshotParts const& parts);

    /// Trails take no more memory than this. Call it before follow_trails().
    void limit_trails(std::size_t most_bytes) { trails_ = Trails(most_bytes); }

    /// Adds the present positions to the trails. Call it after each step from which trails are wanted.
    void follow_trails();

    /// Trails, and ranges of values, begin anew.
    void forget() {
        trails_.clear();
        ranges_.clear();
    }

    /// The messages that pictures show if they are to, see SnapshotParts::heard. It outlives this.
    void show_heard(HeardMessages* heard) { heard_ = heard; }

private:
    std::shared_ptr<LightMap const> light();
    /// With the range of all values so far.
    std::optional<RobotColumn> column(std::string const& name);

    World const& world_;
    Lighting const& lighting_;
    std::shared_ptr<Scenery const> scenery_;
    std::shared_ptr<LightMap const> light_;  // the last one handed out
    Trails trails_;
    LinkFinder link_finder_;
    std::vector<float> range_mm_;  // of robots, at their present power
    RobotValues values_;
    std::map<std::string, std::pair<float, float>> ranges_;  // of the values of a name so far
    HeardMessages* heard_ = nullptr;                         // null: pictures do not show it
};

}  // namespace pogosim
