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
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/locked_file.hpp"

namespace pogosim {

namespace {

constexpr auto kDatedPattern = "[%Y-%m-%d %H:%M:%S.%e] [%^%l%$] %v";
constexpr auto kMinimalPattern = "%v";
constexpr std::chrono::seconds kFlushPeriod{2};

/// Standard output below `warn`, standard error from there on.
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

struct Loggers {
    std::shared_ptr<spdlog::logger> simulator;
    std::shared_ptr<spdlog::logger> robots;
    LockedFile lock{};  // of the console file
};

/// The first failure to write the console file; empty: none.
std::string& first_failure() {
    static std::string text;
    return text;
}

void keep_first_failure(std::string const& text) {
    if (first_failure().empty()) {
        first_failure() = text;
    }
}

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

template <class Logger>
std::shared_ptr<spdlog::logger> make_logger(char const* name, std::vector<spdlog::sink_ptr> const& sinks) {
    auto logger = std::make_shared<Logger>(name, sinks.begin(), sinks.end());
    logger->set_level(spdlog::level::debug);
    logger->flush_on(spdlog::level::warn);
    logger->set_error_handler(keep_first_failure);
    return logger;
}

spdlog::sink_ptr make_console(LogOptions const& options) {
    auto console = std::make_shared<ConsoleSink>();
    console->set_pattern(options.minimal ? kMinimalPattern : kDatedPattern);
    console->set_level(options.quiet     ? spdlog::level::warn
                       : options.verbose ? spdlog::level::debug
                                         : spdlog::level::info);
    return console;
}

/// The lock of a console file; none for a pipe, say. Parent folders are created.
LockedFile lock_file(std::filesystem::path const& path) {
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

/// A reader of a named pipe, who must be there: opening the pipe would wait for one, and end of file comes to the
/// reader when the last writer has gone.
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
        auto file = std::make_shared<spdlog::sinks::basic_file_sink_st>(options.file, /*truncate=*/true);
        file->set_pattern(kDatedPattern);
        file->set_level(options.verbose ? spdlog::level::debug : spdlog::level::info);
        return file;
    } catch (std::exception const& error) {
        throw OutputError("cannot open the console file '" + options.file + "' (console_filename): " + error.what());
    }
}

Loggers make_loggers(LogOptions const& options) {
    std::vector<spdlog::sink_ptr> simulator_sinks{make_console(options)};
    std::vector<spdlog::sink_ptr> robot_sinks;
    if (options.show_robot_lines) {
        robot_sinks.push_back(simulator_sinks.front());
    }
    LockedFile lock;
    if (!options.file.empty()) {
        simulator_sinks.push_back(make_file(options, lock));
        robot_sinks.push_back(simulator_sinks.back());
    }
    return {make_logger<OneLineLogger>("pogosim", simulator_sinks), make_logger<spdlog::logger>("robot", robot_sinks),
            std::move(lock)};
}

Loggers& loggers() {
    static Loggers instance = make_loggers({});
    return instance;
}

}  // namespace

void start_logging(LogOptions const& options) {
    first_failure().clear();
    loggers().lock = LockedFile();  // this process may open the same console file again
    loggers() = make_loggers(options);
}

spdlog::logger& log() {
    return *loggers().simulator;
}
spdlog::logger& robot_log() {
    return *loggers().robots;
}

void flush_logs() {
    loggers().simulator->flush();
    loggers().robots->flush();
}

void silence_logs() {
    loggers().simulator->set_level(spdlog::level::off);
    loggers().robots->set_level(spdlog::level::off);
}

void flush_logs_if_due() {
    using Clock = std::chrono::steady_clock;
    static Clock::time_point next = Clock::now() + kFlushPeriod;
    if (Clock::now() >= next) {
        flush_logs();
        next = Clock::now() + kFlushPeriod;
    }
}

void check_logs() {
    flush_logs();
    if (!first_failure().empty()) {
        throw OutputError("cannot write the console file (console_filename): " + first_failure());
    }
}

}  // namespace pogosim
