// The command line of every simulated program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pogosim {

struct CommandLine {
    std::string program_name;  // without folders
    std::string config;
    bool no_gui = false;
    bool close_at_end = false;  // the window
    bool verbose = false;
    bool quiet = false;
    bool hide_robot_lines = false;
    bool progress_bar = false;
    bool strict = false;         // unknown keys and unread parameters are errors
    bool strict_config = false;  // values that would be cut, or replaced by a default, are errors
    bool check_config = false;   // nothing is run
    std::string picture;         // file of a picture of the start, with check_config; empty: none
    std::optional<std::uint32_t> seed;
    std::string video;                 // file of a film; empty: none
    std::string profile;               // file of a profile of robots' firmware; empty: none
    std::uint32_t profile_robots = 1;  // how many robots are in it
    std::string firmware;              // that drives robots in the place of the program; empty: none does
    std::optional<int> gdb_port{};     // debug a robot that runs firmware
    std::optional<std::uint32_t> gdb_robot{};
    std::string save_state;                // file that gets the state of the run; empty: none
    std::optional<double> save_at_s{};     // absent: at its end
    std::optional<double> save_every_s{};  // of wall-clock time; absent: once
    std::string from_state;                // file with the state from which the run goes on; empty: it begins anew
    std::int64_t hash_period_steps = 0;    // 0: no hashes
    std::vector<std::string> overrides;    // --set, in order
};

/// The parsed options; or, after --help, --version or an error, the exit code of the program, once everything has been
/// printed.
struct ParsedCommandLine {
    CommandLine options;
    std::optional<int> exit_code;
};

ParsedCommandLine parse_command_line(int argc, char const* const* argv);

}  // namespace pogosim
