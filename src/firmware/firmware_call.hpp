// A call of a function of the robots' library (Pogolib) by a firmware: its arguments, its result, and what it may act
// on. Arguments and results are passed as by the ilp32 calling convention (RISC-V ELF psABI Specification, version 1.0,
// 2022, chapter "Calling Conventions").
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "device/arguments.hpp"
#include "firmware/firmware_program.hpp"
#include "firmware/firmware_robot.hpp"
#include "riscv/core.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Messages and lines of the robots of one part of the swarm.
struct FirmwareOutbox {
    struct Said {
        std::uint32_t robot = 0;
        std::uint32_t ticks = 0;  // that it had made
        Slip slip{};  // of a warning, which is given once in a run; without an outcome: a line that it has printed
        std::string text{};
    };
    TransmissionQueue air;
    std::vector<Said> said;

    void clear() {
        air.clear();
        said.clear();
    }
};

/// A firmware gives a function an address that it cannot use.
struct WrongAddress : std::exception {
    std::string_view function;
    std::uint32_t address;
    std::string_view why;

    WrongAddress(std::string_view its_function, std::uint32_t its_address,
                 std::string_view its_why = "where there is no memory that it could use")
        : function(its_function), address(its_address), why(its_why) {}
    char const* what() const noexcept override { return "wrong address"; }
};

/// The configuration refuses what a firmware asks for: that ends the run.
struct RefusedCall : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What becomes of the robot after a call.
enum class CallOutcome : std::uint8_t {
    returns,  // it goes on
    sleeps,   // it goes on when its clock is reached
    repeats,  // when its clock is reached, it calls the function again
    ends      // it does nothing any more
};

struct FirmwareCall {
    World& world;
    std::uint32_t robot;
    FirmwareRobot& self;
    FirmwareProgram const& program;
    FirmwareOutbox& out;
    std::string_view function;  // its name
    CallTimes const& times;
    double time_us = 0.0;  // that it takes, where time is counted

    std::int64_t& clock_us() const { return world.devices.clock_us[robot]; }

    /// pogobot_ticks; 0 if the program has none.
    std::uint32_t ticks() const;

    /// Argument number i, from 0 to 7.
    std::uint32_t argument(std::size_t i) const { return self.core.x[10 + i]; }
    std::uint8_t byte(std::size_t i) const { return static_cast<std::uint8_t>(argument(i)); }
    std::uint16_t half(std::size_t i) const { return static_cast<std::uint16_t>(argument(i)); }
    std::int32_t number(std::size_t i) const { return static_cast<std::int32_t>(argument(i)); }

    void give(std::uint32_t result) const { self.core.x[10] = result; }
    void give_signed(std::int32_t result) const { give(static_cast<std::uint32_t>(result)); }
    void give_float(float result) const;

    // Reading and writing memory throw WrongAddress.

    void read(std::uint32_t address, std::span<std::byte> bytes) const;
    void write(std::uint32_t address, std::span<std::byte const> bytes) const;
    std::uint32_t read_word(std::uint32_t address) const;
    void write_word(std::uint32_t address, std::uint32_t value) const;
    void require_aligned(std::uint32_t address) const;

    /// Warns once in a run for each function and argument.
    template <class Value>
    [[gnu::cold, gnu::noinline]] void note_slip(WrongArgument const& wrong, Value const& value) const {
        Slip const slip{function, wrong.name, wrong.expected, wrong.outcome};
        out.said.push_back({robot, ticks(), slip, slip_text(slip, value)});
    }

    /// Warns once in a run for each function and `kind`, a literal.
    void warn_once(std::string_view kind, std::string text) const;

    /// Notes wrong arguments, see device/arguments.hpp.
    template <class Value>
    void operator()(WrongArgument const& wrong, Value const& value) const {
        note_slip(wrong, value);
    }

    RobotModel const& model() const { return world.spec_of(robot).model; }
};

/// How calls count that may be in a loop that waits, see kFreeCalls. Before its main loop begins, a program waits only
/// for inputs, not for the clock.
enum class Noted : std::uint8_t { as_call, as_clock, at_line_end };

/// What a function does with the stopwatch that is its first argument, by which the ticks of a main loop are known.
enum class StopwatchUse : std::uint8_t { none, resets, reads };

/// A function of the library, by the name of its symbol.
struct LibraryFunction {
    std::string_view name;
    CallOutcome (*call)(FirmwareCall& call);
    float CallTimes::*time = &CallTimes::call_us;  // that it takes, besides what it adds itself
    Noted noted = Noted::as_call;
    bool is_random = false;  // only if random numbers are the simulator's
    StopwatchUse use = StopwatchUse::none;
};

/// All of them, in an order that does not change while the process runs.
std::span<LibraryFunction const> library_functions();

/// "it jumped to 0x00000000, where there is no code: ...". For reasons that a program can be blamed for.
std::string text_of(Stop const& stop, FirmwareRobot const& robot, Firmware const& firmware);

std::string text_of(WrongAddress const& wrong);

/// Whether a robot has called a function that the simulator has no code for, see emu/stubs.S.
bool is_without_code(FirmwareRobot const& robot);

// The parts of library_functions(), by what they act on.

/// What functions do that only set up hardware: devices are ready at the start of a run.
CallOutcome do_nothing(FirmwareCall& call);

std::span<LibraryFunction const> clock_functions();
std::span<LibraryFunction const> console_functions();
std::span<LibraryFunction const> device_functions();
std::span<LibraryFunction const> flash_functions();
std::span<LibraryFunction const> helper_functions();
std::span<LibraryFunction const> infrared_functions();

}  // namespace pogosim
