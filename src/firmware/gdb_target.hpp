// What a debugger can see and change of a robot: the interface between gdb's protocol and the robot itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pogosim {

// Numbers of registers, as in the description that gdb gets: x0 to x31, then pc.
inline constexpr std::size_t kGdbProgramCounter = 32;
inline constexpr std::size_t kGdbRegisters = 33;

/// Where, or at what, a robot stops: the types of gdb's packets Z0 to Z4, in their order.
enum class GdbPointKind : std::uint8_t { software_breakpoint, hardware_breakpoint, write, read, access };

struct GdbPoint {
    GdbPointKind kind = GdbPointKind::software_breakpoint;
    std::uint32_t address = 0;
    std::uint32_t bytes = 0;  // of a watchpoint; of a breakpoint: of the instruction

    bool is_breakpoint() const { return kind <= GdbPointKind::hardware_breakpoint; }
    friend bool operator==(GdbPoint const&, GdbPoint const&) = default;
};

/// Signals, with gdb's numbers. Source: GDB manual, appendix E, and include/gdb/signals.def there.
enum class GdbSignal : std::uint8_t {
    interrupt = 2,
    illegal_instruction = 4,
    trap = 5,
    abort = 6,
    bus_error = 10,
    segmentation = 11
};

/// Why a robot has stopped.
struct GdbStop {
    GdbSignal signal = GdbSignal::trap;
    std::optional<GdbPoint> watchpoint{};  // that was hit; its address is where, within the watched bytes

    friend bool operator==(GdbStop const&, GdbStop const&) = default;
};

/// How a robot goes on: until something stops it, or while it is in [first, last) after each instruction. An empty
/// range is one instruction.
struct GdbResume {
    bool is_step = false;
    std::uint32_t first = 0;
    std::uint32_t last = 0;

    friend bool operator==(GdbResume const&, GdbResume const&) = default;
};

/// A robot that stands still. It does not run inside of these functions: resume() says how it will once the debugger
/// has been answered, since it is the simulator that runs robots, and others meanwhile.
class GdbTarget {
public:
    virtual ~GdbTarget() = default;

    /// `number` is below kGdbRegisters.
    virtual std::uint32_t read_register(std::size_t number) const = 0;
    virtual void write_register(std::size_t number, std::uint32_t value) = 0;

    /// Reads as many bytes as there are from an address on, up to those asked for; returns how many. 0 is a fault.
    virtual std::size_t read_memory(std::uint32_t address, std::span<std::byte> bytes) const = 0;

    /// False, and without effect, if not all of them can be written.
    virtual bool write_memory(std::uint32_t address, std::span<std::byte const> bytes) = 0;

    /// False if there are too many already. One that is there already stays.
    virtual bool insert(GdbPoint const& point) = 0;
    virtual void remove(GdbPoint const& point) = 0;

    virtual GdbStop stopped() const = 0;
    virtual void resume(GdbResume const& how) = 0;
    /// The debugger leaves: all points are gone, and the robot goes on without it.
    virtual void detach() = 0;
    /// The debugger wants the run to end.
    virtual void kill() = 0;

    /// The answer to "monitor COMMAND", lines that end with '\n'. Empty: there is no such command.
    virtual std::string monitor(std::string_view command) const = 0;
};

}  // namespace pogosim
