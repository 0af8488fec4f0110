// Robots that do what a list says at given times of their own clocks: for tests and teaching.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "brain/brain.hpp"
#include "world/brain_spec.hpp"

namespace pogosim {

class ScriptBrain final : public Brain {
public:
    /// Drives the robots of a category, an index into World::categories, by its script, which is in order of time.
    /// `world` outlives this.
    ScriptBrain(World& world, std::uint32_t category);

    bool run_step() override;
    void append_state(std::vector<std::byte>& bytes) const override;
    void take_state(std::span<std::byte const>& bytes) override;

private:
    void tick(std::uint32_t robot);
    void carry_out(ScriptSpec::Entry const& entry, std::uint32_t robot);

    World& world_;
    RobotRange range_;
    ScriptSpec script_;
    std::vector<std::uint32_t> next_;  // of each robot: its next entry
};

}  // namespace pogosim
