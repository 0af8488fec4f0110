// A robot that is debugged with gdb: runs its core in the place of run(), and stops where gdb asks for it.
//
// gdb debugs a processor that stops and goes on; the simulator runs a robot in pieces, from one call of the library to
// the next, with other robots and simulated time between them. For gdb, a call of the library is one instruction, at
// the address of the function, however much time passes until the robot runs again. While the robot stands still, so
// does the whole simulation, which is inside of run() then.
//
// Instructions, and the cycles that they take, are the same as without gdb. Where only breakpoints are set, the robot
// runs as fast as otherwise, on a copy of its code in which their addresses are intercepted; with watchpoints, which
// are looked at after each instruction, it is slow.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware/gdb_protocol.hpp"
#include "firmware/gdb_server.hpp"
#include "firmware/gdb_target.hpp"
#include "firmware/observer.hpp"
#include "riscv/core.hpp"

namespace pogosim {

/// The robot that is debugged, and what its run gives to the session.
struct GdbRobot {
    std::uint32_t index = 0;  // in World::robots
    std::uint32_t id = 0;
    std::string category{};
    std::string firmware{};  // its file
    // "t = 0.016 s, tick 1", for `monitor time`.
    std::function<std::string()> time = [] { return std::string(); };
    std::function<bool()> interrupted = [] { return false; };  // by Ctrl-C in the simulator's terminal
    std::function<void()> end_run = [] {};                     // after the present step
};

class GdbSession final : public FirmwareObserver, private GdbTarget {
public:
    /// Listens; see GdbServer for the port and its errors.
    GdbSession(GdbRobot robot, int port);
    /// Tells gdb that the program is over.
    ~GdbSession() override;
    GdbSession(GdbSession const&) = delete;
    GdbSession& operator=(GdbSession const&) = delete;

    std::uint32_t robot() const { return robot_.index; }
    std::uint16_t port() const { return server_.port(); }

    bool observes(std::uint32_t robot) const override { return robot == robot_.index; }
    Stop run(std::uint32_t /*robot*/, Core& core, Memory& memory, Code const& code, std::uint64_t most_cycles,
             double /*clock_us*/) override {
        return run(core, memory, code, most_cycles);
    }
    void look(std::uint32_t /*robot*/, Core& core, Memory& memory, Code const& code) override {
        look(core, memory, code);
    }
    void show_failure(std::uint32_t /*robot*/, Core& core, Memory& memory, Code const& code) override {
        show_failure(core, memory, code);
    }

    /// As run() of riscv/core.hpp, for the robot that is debugged. The first call waits for gdb. A fault is shown to
    /// gdb, and is returned only if the robot gets to it once more when gdb lets it go on.
    Stop run(Core& core, Memory& memory, Code const& code, std::uint64_t most_cycles);

    /// For Ctrl-C, and debuggers that connect, while the robot waits or has ended: to be called in each step.
    void look(Core& core, Memory& memory, Code const& code);

    /// Shows gdb that the simulator has to give the robot up, before it does so: a function of the library cannot do
    /// its work, for example. A fault has been shown already.
    void show_failure(Core& core, Memory& memory, Code const& code);

private:
    struct Watched {
        GdbPoint point;
        std::vector<std::byte> before{};  // what was there
    };
    class Scope;

    void wait_for_peer();
    void look_at_peer();
    void take(std::string_view bytes);
    void show(GdbStop const& stop);
    void welcome_peer();
    void forget_peer();
    bool has_breakpoint(std::uint32_t address) const;
    bool is_at_breakpoint() const;
    bool is_single_step() const;
    void end_call();
    void note_progress();
    bool is_shown(Stop const& fault);
    std::optional<GdbPoint> touched_point() const;
    std::optional<GdbPoint> changed_point() const;
    void renew_watched();
    Code const& code_with_breakpoints();
    void show_library_as_returns(std::uint32_t address, std::span<std::byte> bytes) const;

    // What gdb sees: the robot that runs, or stands still, now.
    std::uint32_t read_register(std::size_t number) const override;
    void write_register(std::size_t number, std::uint32_t value) override;
    std::size_t read_memory(std::uint32_t address, std::span<std::byte> bytes) const override;
    bool write_memory(std::uint32_t address, std::span<std::byte const> bytes) override;
    bool insert(GdbPoint const& point) override;
    void remove(GdbPoint const& point) override;
    GdbStop stopped() const override { return stop_; }
    void resume(GdbResume const& how) override;
    void detach() override;
    void kill() override;
    std::string monitor(std::string_view command) const override;

    GdbRobot robot_;
    GdbServer server_;
    GdbReader reader_;
    std::optional<GdbProtocol> protocol_;  // for each peer a new one

    // The robot in run(), look() or show_failure().
    Core* core_ = nullptr;
    Memory* memory_ = nullptr;
    Code const* code_ = nullptr;

    bool has_waited_ = false;            // for the first peer
    bool is_stopped_ = false;            // until gdb resumes it
    bool owes_reply_ = false;            // gdb has resumed it, and waits until it stops
    bool is_interrupt_pending_ = false;  // Ctrl-C has come
    bool is_leaving_ = false;            // gdb has detached
    bool ends_run_ = false;              // by its wish
    GdbStop stop_;                       // the last one
    GdbResume how_;                      // it goes on

    std::vector<GdbPoint> breakpoints_;
    std::vector<Watched> watched_;
    std::optional<Code> code_with_breakpoints_;  // absent: to be made

    std::optional<std::uint32_t> passed_;  // address of a breakpoint that was shown: the robot goes on there
    std::optional<std::uint32_t> called_;  // function of the library that the simulator was left with
    std::optional<GdbPoint> touched_;      // watchpoint that the instruction at pc reads or writes
    std::optional<Stop> shown_fault_;
    std::optional<GdbSignal> ended_by_;
};

}  // namespace pogosim
