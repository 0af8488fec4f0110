#include "render/film_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <spawn.h>
#ifdef __linux__
#include <sys/mman.h>
#endif
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <system_error>

#include "base/environment.hpp"
#include "base/locked_file.hpp"
#include "base/save_progress.hpp"

namespace pogosim {

namespace {

constexpr long kLookPeriodNs = 10'000'000;
constexpr int kLookPeriodMs = 100;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kLongestStall{20};  // without taking a byte; the run waits so long
constexpr std::chrono::seconds kLongestEnd{300};   // of what it does with a whole film

/// The end of the pipe must not be inherited by children of the user's program: while one of them has it open, ffmpeg
/// does not see the end of the film.
std::atomic<int> open_pipe = -1;

void close_in_forked_children() {
    static std::once_flag once;
    std::call_once(once, [] {
        pthread_atfork(nullptr, nullptr, [] {
            if (int const descriptor = open_pipe.exchange(-1); descriptor >= 0) {
                close(descriptor);
            }
        });
    });
}

/// A file without a name, which is removed when it is closed; if there is no room for one, ffmpeg's messages are lost.
int make_output() {
#ifdef __linux__
    if (int const memory = memfd_create("ffmpeg", MFD_CLOEXEC); memory >= 0) {
        return memory;
    }
#endif
    std::error_code error;
    std::string name = std::filesystem::temp_directory_path(error) / "pogosim-XXXXXX";
    int const descriptor = error ? -1 : mkstemp(name.data());
    if (descriptor < 0) {
        return open("/dev/null", O_RDWR | O_CLOEXEC);
    }
    fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    unlink(name.c_str());
    return descriptor;
}

/// Both ends are closed in child programs.
std::array<int, 2> make_pipe() {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) {
        fail_with_errno(errno);
    }
    for (int const end : ends) {
        fcntl(end, F_SETFD, FD_CLOEXEC);
    }
    return ends;
}

/// How a child starts: with usual signals, its own process group, and these descriptors.
class SpawnSettings {
public:
    SpawnSettings(int input, int output) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, output, STDERR_FILENO);
        posix_spawnattr_init(&attributes_);
        sigset_t none;
        sigset_t all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes_, &none);
        posix_spawnattr_setsigdefault(&attributes_, &all);
        posix_spawnattr_setpgroup(&attributes_, 0);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    }
    ~SpawnSettings() {
        posix_spawn_file_actions_destroy(&actions_);
        posix_spawnattr_destroy(&attributes_);
    }
    SpawnSettings(SpawnSettings const&) = delete;
    SpawnSettings& operator=(SpawnSettings const&) = delete;

    posix_spawn_file_actions_t const* actions() const { return &actions_; }
    posix_spawnattr_t const* attributes() const { return &attributes_; }

private:
    posix_spawn_file_actions_t actions_{};
    posix_spawnattr_t attributes_{};
};

}  // namespace

FilmProcess::FilmProcess(std::vector<std::string> const& arguments) : output_(make_output()) {
    close_in_forked_children();
    auto const [read_end, write_end] = make_pipe();
    input_ = write_end;
    open_pipe = write_end;
    fcntl(write_end, F_SETFL, O_NONBLOCK);  // a stalled encoder must not hold up the run for ever
    try {
        spawn(arguments, read_end);
    } catch (...) {
        close(read_end);
        close_input();
        close(output_);
        throw;
    }
    close(read_end);
}

void FilmProcess::spawn(std::vector<std::string> const& arguments, int input) {
    std::string name = "ffmpeg";
    std::vector<std::string> words = arguments;
    std::vector<char*> pointers{name.data()};
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    SpawnSettings const settings(input, output_);
    int const error = posix_spawnp(&process_, name.c_str(), settings.actions(), settings.attributes(), pointers.data(),
                                   environment());
    if (error != 0) {
        process_ = -1;
        fail_with_errno(error);
    }
}

FilmProcess::~FilmProcess() {
    finish();
    close(output_);
}

bool FilmProcess::write(std::span<std::byte const> bytes) {
    auto last_taken = Clock::now();
    while (!bytes.empty()) {
        ssize_t const count = ::write(input_, bytes.data(), bytes.size());
        if (count >= 0) {
            bytes = bytes.subspan(static_cast<std::size_t>(count));
            ++save_progress().writes;
            last_taken = Clock::now();
        } else if (errno == EAGAIN) {
            if (Clock::now() - last_taken > kLongestStall) {
                stop("it took no picture for 20 s");
                return false;
            }
            pollfd ready{.fd = input_, .events = POLLOUT, .revents = 0};
            poll(&ready, 1, kLookPeriodMs);
        } else if (errno != EINTR) {
            return false;
        }
    }
    return true;
}

void FilmProcess::stop(char const* why) {
    if (process_ >= 0) {
        kill(process_, SIGKILL);
    }
    reason_ = why;
}

void FilmProcess::close_input() {
    if (input_ >= 0) {
        open_pipe = -1;
        close(input_);
        input_ = -1;
    }
}

bool FilmProcess::finish() {
    close_input();
    int status = 0;
    auto const start = Clock::now();
    while (process_ >= 0) {
        if (reason_.empty() && Clock::now() - start > kLongestEnd) {
            stop("it did not end within 5 minutes");
        }
        pid_t const ended = waitpid(process_, &status, WNOHANG);
        if (ended == process_) {
            has_succeeded_ = WIFEXITED(status) && WEXITSTATUS(status) == 0;
            process_ = -1;
        } else if (ended < 0 && errno == ECHILD) {  // the user's program has waited for it, or ignores its children
            has_succeeded_ = output().empty();
            process_ = -1;
        } else {
            timespec const pause{.tv_sec = 0, .tv_nsec = kLookPeriodNs};
            nanosleep(&pause, nullptr);
            ++save_progress().writes;  // the encoder is at work
        }
    }
    return has_succeeded_;
}

std::string FilmProcess::output() const {
    if (!reason_.empty()) {
        return reason_;
    }
    std::string text;
    std::array<char, 4096> piece{};
    while (true) {
        ssize_t const count = pread(output_, piece.data(), piece.size(), static_cast<off_t>(text.size()));
        if (count <= 0) {
            return text;
        }
        text.append(piece.data(), static_cast<std::size_t>(count));
    }
}

}  // namespace pogosim
