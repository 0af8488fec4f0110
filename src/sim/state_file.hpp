// The file of --save-state, from which --from-state goes on: in the format of the machine that wrote it,
//
//     8 bytes  "PGSTATE\0"
//     u32      version of this format
//     u64      bytes of what follows, but for the checksum
//     ...      what kind of run it is (StateFile without its last member)
//     u64      bytes of the state
//     ...      the state
//     u64      FNV-1a over all bytes so far
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/locked_file.hpp"
#include "base/state_bytes.hpp"
#include "brain/brain.hpp"
#include "config/scenario.hpp"
#include "process/program_image.hpp"
#include "world/world.hpp"

namespace pogosim {

/// What must be the same for a run to go on from the state of another one.
struct RunIdentity {
    std::string version;        // of Pogosim
    std::string build;          // of its library
    std::string program;        // name of the executable
    std::string program_build;  // empty: there is none
    std::string configuration;  // without what only says what is written and shown, and for how long
    std::uint64_t files = 0;    // hash of what the configuration reads from other files

    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.version, self.build, self.program, self.program_build, self.configuration, self.files);
    }
};

/// The identity of a run that has not begun. What it has read from files is taken as it was read: the files may change
/// during the run. `inputs`: the InputHash of its world. Scripts, robot models and costs are in the configuration, word
/// for word.
RunIdentity identity_of(ProgramImage const& image, Scenario const& scenario, World const& world, Brains const& brains,
                        std::uint64_t inputs);

/// What the file of --save-state holds. The copy of a run in memory is a SavedState.
struct StateFile {
    std::filesystem::path file{};  // from which it was read
    RunIdentity identity{};
    std::uint32_t seed = 0;
    double time_s = 0.0;
    std::uint64_t hash = 0;  // of the run, see state_hash.hpp
    bool has_ended = false;  // by its program
    std::int64_t rows = 0;   // of its data file so far, with those of earlier parts
    std::vector<std::byte> state{};

    /// What comes before the bytes of the state.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.identity, self.seed, self.time_s, self.hash, self.has_ended, self.rows);
    }
};

/// Throws ConfigError for anything but the complete file of a state.
StateFile read_state(std::filesystem::path const& file);

/// Throws ConfigError, which says what is another one, if a run of this identity cannot go on from the state.
void check_identity(StateFile const& saved, RunIdentity const& identity);

/// The file of --save-state: while this exists, no other run can write it.
class StateOutput {
public:
    /// Throws OutputError, and ConfigError for a file that is something else and would be lost.
    explicit StateOutput(std::filesystem::path const& file);

    /// Replaces the file at once as a whole. Throws OutputError; the file is then as before.
    /// `kind`: all but the bytes of the state.
    void write(StateFile const& kind, std::span<std::byte const> state);

private:
    std::filesystem::path name_;
    LockedFile reserved_;
};

}  // namespace pogosim
