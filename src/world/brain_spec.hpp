// What drives the robots of a category: the key `brain`.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "world/rgb.hpp"

namespace pogosim {

/// `brain: program`, the default: a program in C.
struct ProgramSpec {
    friend bool operator==(ProgramSpec const&, ProgramSpec const&) = default;
};

/// `brain: host`: the process that steps the run, by arrays.
struct HostSpec {
    friend bool operator==(HostSpec const&, HostSpec const&) = default;
};

/// `brain: {script: FILE}`, or a list in place of the file: what each robot does at given times of its own clock.
struct ScriptSpec {
    struct Entry {
        double time_s = 0.0;                         // at the first tick from then on
        std::array<std::optional<int>, 3> motors{};  // right, left, back: -1023 to 1023; absent: as before
        std::optional<Rgb> led{};                    // absent: all as before
        int led_id = 0;                              // 0 to 4
        std::string message{};                       // sent once in all directions, up to 382 bytes; empty: none

        friend bool operator==(Entry const&, Entry const&) = default;
    };
    std::vector<Entry> entries;  // by time, ascending

    friend bool operator==(ScriptSpec const&, ScriptSpec const&) = default;
};

/// Whose rand() and srand() a firmware calls.
enum class FirmwareRandom : std::uint8_t {
    own,       // those of its C library, as on the robot
    simulator  // those of a program in C: each robot has a stream of its own, set by the seed of the run
};

/// `brain: FILE.elf`, or `brain: {firmware: FILE.elf}`: a program's machine code, as the robots' compiler makes it.
struct FirmwareSpec {
    std::string file;
    FirmwareRandom random = FirmwareRandom::own;
    std::optional<std::vector<std::string>> columns{};  // variables that are columns of the data file

    friend bool operator==(FirmwareSpec const&, FirmwareSpec const&) = default;
};

using BrainSpec = std::variant<ProgramSpec, HostSpec, ScriptSpec, FirmwareSpec>;

/// Whether robots with this brain need a program.
inline bool needs_program(BrainSpec const& brain) {
    return std::holds_alternative<ProgramSpec>(brain);
}

}  // namespace pogosim
