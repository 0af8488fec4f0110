// Many runs of one program: a process that has loaded the program does one run after the other. What takes most of the
// time before a short run (the dynamic linker, symbols) is done once, and no process is made for a run.
//
// A run is what it would be in a process of its own: the program's variables are set back before each. Where a program
// may keep something else (memory that it allocates, static objects in C++, a library with a state of its own), each
// run has a copy of the process instead (fork), made before the first run.
//
// The other side (python/pogosim/batch/runs/run_server.py) has one end of a pair of sockets. This end is the descriptor
// that the variable POGOSIM_SERVE_RUNS of the environment names:
//
//     from here                                               to here
//     ----------------------------------------------------------------------------------------------
//     kServerGreeting, once runs can be asked for,
//     and why each has a copy of the process, a line:
//     empty if none has
//                                                             size of a request, 4 bytes;
//                                                             file of the log, arguments, each ended by a zero
//     exit code of the run, 4 bytes; kNotRepeated, and
//     the end of the server: do all runs elsewhere
//                                                             ..., or the end of the stream: no more runs
//
// After a run that failed, the server ends. The other side repeats this run in a process of its own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "process/program_image.hpp"

namespace pogosim {

inline constexpr int kNotRepeated = -1;
inline constexpr char kServerGreeting[] = "pogosim run server 1\n";

/// To be called before constructors of the user's program. Counts what the process has until then.
void expect_run_server();

/// Whether this process is to serve runs.
bool is_run_server();

/// Serves runs until the end of the stream. Returns the exit code of this process, which in a copy is that of its run.
///
/// Runs are not served, and there is no greeting, for a program whose code before main() a copy would not repeat, see
/// why_process_is_not_copied(), or has started threads, which a copy lacks, or opened files, which copies share.
int serve_runs(ProgramImage const& program, std::function<int(std::vector<std::string> arguments)> const& run);

}  // namespace pogosim
