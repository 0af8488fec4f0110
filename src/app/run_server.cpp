#include "app/run_server.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>

#include "app/process_copies.hpp"
#include "process/process.hpp"
#include "process/program_memory.hpp"
#include "record/tables_module.hpp"
#include "robot/shared_state.hpp"
#include "robot/static_objects.hpp"

namespace pogosim {

namespace {

constexpr auto kVariable = "POGOSIM_SERVE_RUNS";
constexpr std::uint32_t kLongestRequest = 1U << 24U;

// ---- The stream

bool read_all(int descriptor, void* into, std::size_t size) {
    auto* const bytes = static_cast<char*>(into);
    for (std::size_t done = 0; done < size;) {
        ssize_t const got = read(descriptor, bytes + done, size - done);
        if (got == 0 || (got < 0 && errno != EINTR)) {
            return false;
        }
        done += got > 0 ? static_cast<std::size_t>(got) : 0;
    }
    return true;
}

bool write_all(int descriptor, void const* from, std::size_t size) {
    auto const* const bytes = static_cast<char const*>(from);
    for (std::size_t done = 0; done < size;) {
        ssize_t const put = write(descriptor, bytes + done, size - done);
        if (put < 0 && errno != EINTR) {
            return false;
        }
        done += put > 0 ? static_cast<std::size_t>(put) : 0;
    }
    return true;
}

struct Request {
    std::string log;
    std::vector<std::string> arguments;
};

/// Nothing at the end of the stream.
std::optional<Request> next_request(int descriptor) {
    std::uint32_t size = 0;
    if (!read_all(descriptor, &size, sizeof(size)) || size > kLongestRequest) {
        return std::nullopt;
    }
    std::string text(size, '\0');
    if (!read_all(descriptor, text.data(), size)) {
        return std::nullopt;
    }
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t const end = std::min(text.find('\0', begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    if (words.empty()) {
        return std::nullopt;
    }
    return Request{.log = words.front(), .arguments = {words.begin() + 1, words.end()}};
}

bool reply(int descriptor, int exit_code) {
    auto const code = static_cast<std::int32_t>(exit_code);
    return write_all(descriptor, &code, sizeof(code));
}

// ---- The process

/// What copies of a process share, or lack.
struct Held {
    std::ptrdiff_t threads = 0;
    std::ptrdiff_t files = 0;
    bool operator==(Held const&) const = default;
};

Held held_now() {
    return {.threads = count_threads(), .files = count_entries("/dev/fd")};
}

std::optional<Held> held_before_constructors;

/// The descriptor that the environment names, of which programs need not know; -1: none.
int take_descriptor() {
    char const* const value = std::getenv(kVariable);
    std::string_view const text = value == nullptr ? "" : value;
    int descriptor = -1;
    std::from_chars(text.data(), text.data() + text.size(), descriptor);
    unsetenv(kVariable);
    fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    return descriptor;
}

/// Both outputs go to the log. False if it cannot be written.
bool log_to(std::string const& file) {
    constexpr mode_t mode = 0666;
    int const log = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode);
    if (log < 0) {
        return false;
    }
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    close(log);
    return true;
}

/// This process, a copy, ends with the server.
void end_with(pid_t server) {
    end_soon_after(server);
    if (getppid() != server) {
        end_process(EXIT_FAILURE);
    }
}

/// The variables of a program as they were when this was made.
class FirstVariables {
public:
    explicit FirstVariables(std::span<std::span<std::byte> const> variables) {
        for (std::span<std::byte> const piece : variables) {
            Kept kept{.place = piece, .bytes = std::vector<std::byte>(piece.size())};
            copy_program_bytes(kept.bytes.data(), piece.data(), piece.size());
            pieces_.push_back(std::move(kept));
        }
    }

    void set_back() const {
        for (Kept const& piece : pieces_) {
            copy_program_bytes(piece.place.data(), piece.bytes.data(), piece.bytes.size());
        }
    }

private:
    struct Kept {
        std::span<std::byte> place;
        std::vector<std::byte> bytes;
    };
    std::vector<Kept> pieces_;
};

using Run = std::function<int(std::vector<std::string> arguments)>;

/// One run after the other in this process.
int serve_in_place(int descriptor, ProgramImage const& program, Run const& run) {
    FirstVariables const first(program.variables);
    while (std::optional<Request> request = next_request(descriptor)) {
        if (!log_to(request->log)) {
            return EXIT_FAILURE;
        }
        first.set_back();
        int const code = run(std::move(request->arguments));
        std::fflush(nullptr);
        bool const is_repeated =
            functions_at_end() == 0;  // as atexit() makes them: the end of the process is their time
        if (code != EXIT_SUCCESS || !reply(descriptor, is_repeated ? code : kNotRepeated) || !is_repeated) {
            return code;
        }
    }
    return EXIT_SUCCESS;
}

/// What each copy would load otherwise.
void load_what_runs_need() {
    try {
        tables_module();
    } catch (std::exception const&) {
        // Runs say it.
    }
}

/// Each run in a copy of this process.
int serve_copies(int descriptor, Run const& run) {
    load_what_runs_need();
    std::signal(SIGCHLD, SIG_DFL);  // else the system forgets how copies have ended
    pid_t const server = getpid();
    while (std::optional<Request> request = next_request(descriptor)) {
        pid_t const copy = fork_executable();
        if (copy == 0) {
            end_with(server);
            close(descriptor);
            return log_to(request->log) ? run(std::move(request->arguments)) : EXIT_FAILURE;
        }
        int status = 0;
        pid_t ended = -1;
        do {
            ended = waitpid(copy, &status, 0);
        } while (ended < 0 && errno == EINTR);
        if (copy < 0 || ended != copy || status != 0 || !reply(descriptor, EXIT_SUCCESS)) {
            break;
        }
    }
    end_process(EXIT_SUCCESS);
}

}  // namespace

void expect_run_server() {
    if (std::getenv(kVariable) != nullptr) {
        held_before_constructors = held_now();
    }
}

bool is_run_server() {
    return held_before_constructors.has_value();
}

int serve_runs(ProgramImage const& program, Run const& run) {
    int const descriptor = take_descriptor();
    std::fflush(nullptr);  // what code before main() has printed: the other side looks for it
    if (held_now() != held_before_constructors || !why_process_is_not_copied(program).empty()) {
        return EXIT_FAILURE;
    }
    std::string const why_copies = why_run_is_not_repeated(program);
    std::string const greeting = kServerGreeting + why_copies + "\n";
    if (!write_all(descriptor, greeting.data(), greeting.size())) {
        return EXIT_FAILURE;
    }
    return why_copies.empty() ? serve_in_place(descriptor, program, run) : serve_copies(descriptor, run);
}

}  // namespace pogosim
