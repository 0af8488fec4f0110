// The console log. Two loggers share the sinks: `log()` speaks for the simulator, `robot_log()` for user programs'
// printf lines. Debug and information go to the standard output, warnings and errors to the standard error.
#pragma once

#include <spdlog/logger.h>

#include <string>

namespace pogosim {

struct LogOptions {
    bool verbose = false;          // debug messages on console and file
    bool quiet = false;            // console: warnings and errors only; takes precedence over verbose
    bool show_robot_lines = true;  // printf lines of robots on the console (the file always has them)
    bool minimal = false;          // console lines without date and level
    std::string file;              // path of the console file; empty: none
};

/// Installs loggers and sinks. Parent folders of the file are created. Throws OutputError if it cannot be opened.
void start_logging(LogOptions const& options);

/// Usable before start_logging: messages from level info on then go to the console.
spdlog::logger& log();
spdlog::logger& robot_log();

/// Writes out what is buffered.
void flush_logs();

/// Stops all logging.
void silence_logs();

/// Flushes buffered output every 2 s, so that it outlives the process. Call it often.
void flush_logs_if_due();

/// Flushes buffered output. Throws OutputError if anything since start_logging did not reach the console file.
void check_logs();

}  // namespace pogosim
