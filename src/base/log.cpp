#include "base/log.hpp"

#include <fcntl.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/current_log.hpp"
#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/locked_file.hpp"

namespace pogosim {

namespace {

constexpr auto kDatedPattern = "[%Y-%m-%d %H:%M:%S.%e] [%^%l%$] %v";
constexpr auto kMinimalPattern = "%v";
constexpr auto kRobotLogger = "robot";
constexpr std::chrono::seconds kFlushPeriod{2};

/// Writes levels below `warn` to standard output, the others to standard error.
class ConsoleSink final : public spdlog::sinks::sink {
public:
    /// Errors of a broken console cannot be reported anywhere.
    void log(spdlog::details::log_msg const& message) override {
        try {
            (message.level >= spdlog::level::warn ? static_cast<sink&>(error_) : static_cast<sink&>(output_))
                .log(message);
        } catch (spdlog::spdlog_ex const&) {
        }
    }
    void flush() override {
        output_.flush();
        error_.flush();
    }
    void set_pattern(std::string const& pattern) override {
        output_.set_pattern(pattern);
        error_.set_pattern(pattern);
    }
    void set_formatter(std::unique_ptr<spdlog::formatter> formatter) override {
        error_.set_formatter(formatter->clone());
        output_.set_formatter(std::move(formatter));
    }

private:
    spdlog::sinks::stdout_color_sink_st output_;
    spdlog::sinks::stderr_color_sink_st error_;
};

/// Each message is a single line, whatever names it quotes.
class OneLineLogger final : public spdlog::logger {
public:
    using logger::logger;

private:
    void sink_it_(spdlog::details::log_msg const& message) override {
        std::string const text = escaped({message.payload.data(), message.payload.size()});
        spdlog::details::log_msg line = message;
        line.payload = text;
        logger::sink_it_(line);
    }
};

/// Passes lines on to the receiver in LogOptions.
class LineSink final : public spdlog::sinks::sink {
public:
    explicit LineSink(std::function<void(LogLine const&)> take) : take_(std::move(take)) {}
    void log(spdlog::details::log_msg const& message) override {
        take_({.is_of_robot = std::string_view(message.logger_name.data(), message.logger_name.size()) == kRobotLogger,
               .level = message.level,
               .text = std::string(message.payload.data(), message.payload.size())});
    }
    void flush() override {}
    void set_pattern(std::string const& /*pattern*/) override {}
    void set_formatter(std::unique_ptr<spdlog::formatter> /*formatter*/) override {}

private:
    std::function<void(LogLine const&)> take_;
};

template <class Logger>
std::shared_ptr<spdlog::logger> make_logger(char const* name, std::vector<spdlog::sink_ptr> const& sinks,
                                            std::string& first_failure) {
    auto logger = std::make_shared<Logger>(name, sinks.begin(), sinks.end());
    logger->set_level(spdlog::level::debug);
    logger->flush_on(spdlog::level::warn);
    logger->set_error_handler([&first_failure](std::string const& text) {
        if (first_failure.empty()) {
            first_failure = text;
        }
    });
    return logger;
}

spdlog::sink_ptr make_console(LogOptions const& options) {
    spdlog::sink_ptr console;
    if (options.on_line) {
        console = std::make_shared<LineSink>(options.on_line);
    } else {
        console = std::make_shared<ConsoleSink>();
        console->set_pattern(options.minimal ? kMinimalPattern : kDatedPattern);
    }
    console->set_level(options.quiet     ? spdlog::level::warn
                       : options.verbose ? spdlog::level::debug
                                         : spdlog::level::info);
    return console;
}

/// The lock of a console file; none for a pipe, say. Parent folders are created.
LockedFile lock_file(std::filesystem::path const& path) {
    check_is_name_of_file(path);
    if (path.has_parent_path()) {
        std::filesystem::create_directories(path.parent_path());
    }
    if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path)) {
        return {};
    }
    LockedFile lock(path);
    lock.keep();
    return lock;
}

/// Opens a named pipe, which must have a reader already: otherwise, opening it would block. The reader gets end of file
/// when the last writer has closed it.
class PipeReader {
public:
    explicit PipeReader(std::filesystem::path const& path) {
        if (std::filesystem::is_fifo(path)) {
            descriptor_ = open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
            if (descriptor_ < 0 && errno == ENXIO) {
                throw FileError("it is a pipe without a reader; start its reader first, or choose a file");
            }
        }
    }
    ~PipeReader() {
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
    }
    PipeReader(PipeReader const&) = delete;
    PipeReader& operator=(PipeReader const&) = delete;

private:
    int descriptor_ = -1;
};

spdlog::sink_ptr make_file(LogOptions const& options, LockedFile& lock) {
    try {
        lock = lock_file(options.file);
        PipeReader const reader(options.file);
        auto file = std::make_shared<spdlog::sinks::basic_file_sink_st>(options.file, /*truncate=*/!options.appends);
        file->set_pattern(kDatedPattern);
        file->set_level(options.verbose ? spdlog::level::debug : spdlog::level::info);
        return file;
    } catch (std::exception const& error) {
        throw OutputError("cannot open the console file '" + options.file + "' (console_filename): " + error.what());
    }
}

}  // namespace

struct Log::Loggers {
    std::shared_ptr<spdlog::logger> simulator;
    std::shared_ptr<spdlog::logger> robots;
    LockedFile lock{};            // of the console file
    std::string first_failure{};  // first failure to write the console file; empty: none
    std::chrono::steady_clock::time_point next_flush = std::chrono::steady_clock::now() + kFlushPeriod;
};

Log::Log(LogOptions const& options) : loggers_(std::make_unique<Loggers>()) {
    std::vector<spdlog::sink_ptr> simulator_sinks{make_console(options)};
    std::vector<spdlog::sink_ptr> robot_sinks;
    if (options.show_robot_lines) {
        robot_sinks.push_back(simulator_sinks.front());
    }
    if (!options.file.empty()) {
        simulator_sinks.push_back(make_file(options, loggers_->lock));
        robot_sinks.push_back(simulator_sinks.back());
    }
    loggers_->simulator = make_logger<OneLineLogger>("pogosim", simulator_sinks, loggers_->first_failure);
    loggers_->robots = make_logger<spdlog::logger>(kRobotLogger, robot_sinks, loggers_->first_failure);
}

Log::~Log() = default;

/// The log of this thread.
struct CurrentLog {
    static std::unique_ptr<Log>& of_process() {
        static std::unique_ptr<Log> log = std::make_unique<Log>(LogOptions{});
        return log;
    }
    static Log& log() { return of_thread != nullptr ? *of_thread : *of_process(); }
    static Log::Loggers& loggers() { return *log().loggers_; }

    static constinit thread_local Log* of_thread;  // null: that of the process
};
constinit thread_local Log* CurrentLog::of_thread = nullptr;

LogScope::LogScope(Log* log) : before_(CurrentLog::of_thread) {
    CurrentLog::of_thread = log;
}

LogScope::~LogScope() {
    CurrentLog::of_thread = before_;
}

Log& current_log() {
    return CurrentLog::log();
}

void start_logging(LogOptions const& options) {
    CurrentLog::of_process().reset();  // this process may open the same console file again
    CurrentLog::of_process() = std::make_unique<Log>(LogOptions{});
    CurrentLog::of_process() = std::make_unique<Log>(options);
}

spdlog::logger& log() {
    return *CurrentLog::loggers().simulator;
}
spdlog::logger& robot_log() {
    return *CurrentLog::loggers().robots;
}

void flush_logs() {
    CurrentLog::loggers().simulator->flush();
    CurrentLog::loggers().robots->flush();
}

void silence_logs() {
    CurrentLog::loggers().simulator->set_level(spdlog::level::off);
    CurrentLog::loggers().robots->set_level(spdlog::level::off);
}

void flush_logs_if_due() {
    using Clock = std::chrono::steady_clock;
    Clock::time_point& next = CurrentLog::loggers().next_flush;
    if (Clock::now() >= next) {
        flush_logs();
        next = Clock::now() + kFlushPeriod;
    }
}

void check_logs() {
    flush_logs();
    if (std::string const& failure = CurrentLog::loggers().first_failure; !failure.empty()) {
        throw OutputError("cannot write the console file (console_filename): " + failure);
    }
}

}  // namespace pogosim
