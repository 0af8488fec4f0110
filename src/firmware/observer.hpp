// Looks on while robots run firmware: a profile of where their cycles go, or a debugger.
#pragma once

#include <cstdint>
#include <string_view>

#include "riscv/core.hpp"
#include "world/world.hpp"

namespace pogosim {

class FirmwareObserver {
public:
    FirmwareObserver() = default;
    virtual ~FirmwareObserver() = default;
    FirmwareObserver(FirmwareObserver const&) = delete;
    FirmwareObserver& operator=(FirmwareObserver const&) = delete;

    /// Whether it looks at this robot.
    virtual bool observes(std::uint32_t robot) const = 0;

    /// It starts, or starts anew.
    virtual void note_start(std::uint32_t /*robot*/) {}

    /// Runs its program as pogosim::run() does. `clock_us`: of the robot now.
    virtual Stop run(std::uint32_t robot, Core& core, Memory& memory, Code const& code, std::uint64_t most_cycles,
                     double clock_us) = 0;

    /// Before each of its steps, whether the robot runs in it or not.
    virtual void look(std::uint32_t /*robot*/, Core& /*core*/, Memory& /*memory*/, Code const& /*code*/) {}

    /// The robot cannot go on.
    virtual void show_failure(std::uint32_t /*robot*/, Core& /*core*/, Memory& /*memory*/, Code const& /*code*/) {}

    /// A tick of its main loop begins, after so many, of which there should be `loop_hz` each second.
    virtual void note_tick(std::uint32_t /*robot*/, std::uint32_t /*ticks*/, int /*loop_hz*/, double /*clock_us*/) {}

    /// The function of the library at this address has taken this time.
    virtual void note_call(std::uint32_t /*robot*/, std::uint32_t /*address*/, double /*time_us*/) {}
};

}  // namespace pogosim
