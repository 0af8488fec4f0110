// The console log. Two loggers share the sinks: `log()` has the simulator's messages, `robot_log()` the printf lines of
// user programs. Debug and information go to the standard output, warnings and errors to the standard error.
//
// A run may have a log of its own, see LogScope; all others share that of the process.
#pragma once

#include <spdlog/logger.h>

#include <functional>
#include <memory>
#include <string>

namespace pogosim {

struct LogLine {
    bool is_of_robot = false;  // printed by a program
    int level = 0;             // as of spdlog: 1 debug, 2 information, 3 warning, 4 error
    std::string text{};
};

struct LogOptions {
    bool verbose = false;          // debug messages on console and file
    bool quiet = false;            // console: warnings and errors only; takes precedence over verbose
    bool show_robot_lines = true;  // printf lines of robots on the console (the file always has them)
    bool minimal = false;          // console lines without date and level
    std::string file{};            // path of the console file; empty: none
    bool appends = false;          // to what is in that file
    // Gets the lines instead of the console; empty: the console gets them.
    std::function<void(LogLine const& line)> on_line{};
};

/// Loggers and their sinks.
class Log {
public:
    /// Parent folders of the file are created. Throws OutputError if it cannot be opened.
    explicit Log(LogOptions const& options);
    ~Log();
    Log(Log const&) = delete;
    Log& operator=(Log const&) = delete;

private:
    friend struct CurrentLog;
    struct Loggers;
    std::unique_ptr<Loggers> loggers_;
};

/// While this exists, the calling thread uses this log; null: that of the process.
class LogScope {
public:
    explicit LogScope(Log* log);
    ~LogScope();
    LogScope(LogScope const&) = delete;
    LogScope& operator=(LogScope const&) = delete;

private:
    Log* before_;
};

/// Replaces the log of the process. Throws like Log's constructor.
void start_logging(LogOptions const& options);

/// Usable before start_logging: messages from level info on then go to the console.
spdlog::logger& log();
spdlog::logger& robot_log();

/// Flushes buffered output.
void flush_logs();

/// Stops all logging.
void silence_logs();

/// Flushes buffered output every 2 s, so that it outlives the process. Call it often.
void flush_logs_if_due();

/// Flushes buffered output. Throws OutputError if anything since start_logging did not reach the console file.
void check_logs();

}  // namespace pogosim
