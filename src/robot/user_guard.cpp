#include "robot/user_guard.hpp"

#include <dlfcn.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csetjmp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <tuple>

#include "base/scratch_file.hpp"
#include "robot/context.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kSignalStackBytes = 65536;
constexpr unsigned kRescueSeconds = 10;
constexpr double kWatchPeriodS = 0.25;   // of processor time
constexpr double kRetryPeriodS = 0.001;  // of processor time
constexpr int kMaxRetries = 250;

struct Guard {
    sigjmp_buf return_point;
    std::atomic<bool> inside = false;
    // Where a crash outside user code goes.
    sigjmp_buf rescue_point;
    std::atomic<bool> rescuable = false;
    std::atomic<unsigned long> calls = 0;
    // What ended the call; plain memory, as a signal handler writes it.
    std::array<char, 512> what{};
    ExitCode code = ExitCode::user_program;
    bool refused = false;
    // The message that needs no more memory, in case the data file cannot be completed.
    std::array<char, 2048> last_words{};
    std::atomic<bool> crashed = false;
    // Watch over processor time.
    double timeout_s = 0.0;
    double period_s = kWatchPeriodS;
    double seen_busy_s = 0.0;
    int retries = 0;
    unsigned long calls_seen = 0;
};

Guard guard;

void set_reason(char const* text) {
    std::strncpy(guard.what.data(), text, guard.what.size() - 1);
    guard.what.back() = '\0';
}

[[noreturn]] void jump_out(ExitCode code) {
    guard.code = code;
    guard.inside = false;
    siglongjmp(guard.return_point, 1);
}

struct CrashName {
    int signal;
    char const* name;
};
constexpr std::array kCrashes{
    CrashName{SIGSEGV, "segmentation fault"},
    CrashName{SIGBUS, "bus error"},
    CrashName{SIGFPE, "arithmetic error (such as an integer division by zero)"},
    CrashName{SIGILL, "illegal instruction"},
    CrashName{SIGABRT, "abort() (such as a failed assert)"},
};

void describe_crash(int signal, siginfo_t const& info) {
    auto const* const crash =
        std::find_if(kCrashes.begin(), kCrashes.end(), [&](CrashName const& c) { return c.signal == signal; });
    if (signal == SIGSEGV || signal == SIGBUS) {
        std::snprintf(guard.what.data(), guard.what.size(), "%s at address %p", crash->name, info.si_addr);
    } else {
        set_reason(crash->name);
    }
}

void set_last_words(char const* where, char const* advice) {
    std::array<char, std::tuple_size_v<decltype(guard.last_words)>> words{};
    std::snprintf(words.data(), words.size(),
                  "pogosim: the user program failed%s: %s. The data file could not be completed. If the program writes "
                  "to memory that is not its own, building it with -fsanitize=address finds where.%s\n",
                  where, guard.what.data(), advice);
    guard.last_words = words;
}

/// Says more and more: each look at what user code may have destroyed can be the last.
void prepare_last_words() {
    set_last_words("", "");
    if (context.world == nullptr) {
        return;  // no user code has run yet
    }
    World const& world = *context.world;
    std::array<char, 512> where{};
    std::array<char, 256> advice{};
    auto const ticks = static_cast<unsigned>(pogobot_ticks);
    std::snprintf(where.data(), where.size(), " in %s, tick %u, t = %.4f s", context.phase, ticks, world.time_s());
    set_last_words(where.data(), "");

    // Runs are repeatable: the same one, ended after the step before this.
    double const time_before_s = std::max(0.0, static_cast<double>(world.step) - 0.5) * world.time_step_s;
    std::snprintf(advice.data(), advice.size(),
                  " To have the data up to there, run it again with -s %u --set simulation_time=%.6f",
                  static_cast<unsigned>(context.services->seed), time_before_s);
    set_last_words(where.data(), advice.data());

    bool const is_robot = context.has_robot();
    std::snprintf(where.data(), where.size(), " in %s of %s%d of category '%s', tick %u, t = %.4f s", context.phase,
                  is_robot ? "robot #" : "", is_robot ? world.robots.id[context.robot] : 0,
                  get_current_robot_category(), ticks, world.time_s());
    set_last_words(where.data(), advice.data());
}

/// Memory is destroyed, or a lock held, beyond what the run needs to end well.
void on_hopeless_rescue(int /*signal*/) {
    [[maybe_unused]] auto const written =
        write(STDERR_FILENO, guard.last_words.data(), std::strlen(guard.last_words.data()));
    remove_scratch_file();
    _exit(static_cast<int>(guard.code));
}

/// What follows may crash or hang for ever; after a while this ends it.
void expect_the_worst() {
    std::signal(SIGALRM, on_hopeless_rescue);
    alarm(kRescueSeconds);
    prepare_last_words();
}

void on_crash(int signal, siginfo_t* info, void* /*context*/) {
    if (guard.crashed.exchange(true)) {
        on_hopeless_rescue(signal);
    }
    describe_crash(signal, *info);
    expect_the_worst();
    if (guard.inside) {
        jump_out(ExitCode::user_program);
    }
    if (guard.rescuable.exchange(false)) {
        siglongjmp(guard.rescue_point, 1);
    }
    on_hopeless_rescue(signal);
}

/// Where the processor was when the signal came; null on a machine that is not known here.
void* program_counter([[maybe_unused]] void const* signal_context) {
#if defined(__linux__) && defined(__x86_64__)
    // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
    return reinterpret_cast<void*>(static_cast<ucontext_t const*>(signal_context)->uc_mcontext.gregs[REG_RIP]);
#elif defined(__linux__) && defined(__aarch64__)
    return reinterpret_cast<void*>(static_cast<ucontext_t const*>(signal_context)->uc_mcontext.pc);
#else
    return nullptr;
#endif
}

/// False in the middle of a library function, such as malloc(): it may hold a lock, which nobody would release.
bool is_in_user_program(void const* signal_context) {
    void* const counter = program_counter(signal_context);
    Dl_info here;
    Dl_info program;
    bool const known = counter != nullptr && dladdr(counter, &here) != 0 &&
                       dladdr(reinterpret_cast<void*>(&robot_main), &program) != 0;
    return !known || here.dli_fbase == program.dli_fbase;
}

void set_watch_period(double period_s) {
    itimerval timer = {};
    timer.it_interval.tv_usec = std::max<suseconds_t>(1000, static_cast<suseconds_t>(period_s * 1e6));
    timer.it_value = timer.it_interval;
    setitimer(ITIMER_PROF, &timer, nullptr);
}

void on_watch(int /*signal*/, siginfo_t* /*info*/, void* signal_context) {
    if (!guard.inside || guard.calls != guard.calls_seen) {
        guard.calls_seen = guard.calls;
        guard.seen_busy_s = 0.0;
        if (guard.retries > 0) {
            guard.retries = 0;
            set_watch_period(guard.period_s);
        }
        return;
    }
    guard.seen_busy_s += guard.retries > 0 ? kRetryPeriodS : guard.period_s;
    if (guard.seen_busy_s < guard.timeout_s) {
        return;
    }
    if (!is_in_user_program(signal_context) && guard.retries < kMaxRetries) {
        ++guard.retries;
        set_watch_period(kRetryPeriodS);
        return;
    }
    std::snprintf(guard.what.data(), guard.what.size(),
                  "did not return within %g s of processor time (user_code_timeout); messages and sensors do not "
                  "change while user code runs, so a step must not wait for them in a loop",
                  guard.timeout_s);
    expect_the_worst();
    jump_out(ExitCode::user_program);
}

void install(int signal, int flags, void (*handler)(int, siginfo_t*, void*)) {
    struct sigaction action = {};
    sigemptyset(&action.sa_mask);
    // A handler leaves by a jump, so its signal must not stay blocked.
    action.sa_flags = flags | SA_NODEFER | SA_SIGINFO;
    action.sa_sigaction = handler;
    sigaction(signal, &action, nullptr);
}

void use_signal_stack() {
    // A stack overflow in user code needs another stack for its handler.
    static std::array<char, kSignalStackBytes> memory;
    stack_t stack = {};
    stack.ss_sp = memory.data();
    stack.ss_size = memory.size();
    sigaltstack(&stack, nullptr);
}

void start_watch(double timeout_s) {
    guard.timeout_s = timeout_s;
    guard.period_s = std::min(kWatchPeriodS, timeout_s / 4.0);
    install(SIGPROF, SA_RESTART, on_watch);
    set_watch_period(guard.period_s);
}

}  // namespace

void install_user_guard(double timeout_s) {
    use_signal_stack();
    for (CrashName const& crash : kCrashes) {
        install(crash.signal, SA_ONSTACK, on_crash);
    }
    if (timeout_s > 0.0) {
        start_watch(timeout_s);
    }
}

std::optional<UserFailure> call_user_code(std::function<void()> const& body) {
    if (sigsetjmp(guard.return_point, 0) != 0) {
        return UserFailure{guard.what.data(), guard.code, guard.refused};
    }
    guard.inside = true;
    guard.refused = false;
    restart_watch();
    try {
        body();
    } catch (std::exception const& error) {
        guard.inside = false;
        return UserFailure{std::string("C++ exception: ") + error.what(), ExitCode::user_program};
    } catch (...) {
        guard.inside = false;
        return UserFailure{"C++ exception", ExitCode::user_program};
    }
    guard.inside = false;
    return std::nullopt;
}

std::optional<UserFailure> call_simulator_code(std::function<void()> const& body) {
    if (sigsetjmp(guard.rescue_point, 0) != 0) {
        return UserFailure{std::string("the simulator crashed (") + guard.what.data() +
                               "), most likely because the user program wrote to memory that is not its own; build the "
                               "program with -fsanitize=address to find where",
                           ExitCode::user_program};
    }
    guard.rescuable = true;
    body();
    guard.rescuable = false;
    return std::nullopt;
}

void restart_watch() {
    guard.calls.store(guard.calls.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

bool inside_user_code() {
    return guard.inside;
}

void abandon_user_code(char const* what, ExitCode code) {
    set_reason(what);
    guard.code = code;
    expect_the_worst();
    jump_out(code);
}

void leave_user_code(char const* what, ExitCode code) {
    if (!guard.inside) {
        std::fprintf(stderr, "pogosim: %s\n", what);
        std::abort();
    }
    set_reason(what);
    jump_out(code);
}

void refuse_user_code(char const* what) {
    guard.refused = true;
    leave_user_code(what, ExitCode::usage);
}

}  // namespace pogosim
