// How fast a swarm runs: an example program at 100, 1000 and 10000 robots on 10^4 mm2 each, headless, without a data
// file. Prints the real-time factor, microseconds per robot and step, the share of each stage, memory per robot, and a
// hash of the final state, which must not depend on the machine's load. Best of several runs, each after a warm-up.
//
//     build/release/bench/bench_run_and_tumble [--json] [--runs N] [--set KEY=VALUE] ... [number of robots ...]
//
// --json prints an object for each number of robots, in a line of its own, for bench/table.py.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/log.hpp"
#include "config/scenario.hpp"
#include "lamps/lamp_types.hpp"
#include "sim/simulation.hpp"

namespace {

using namespace pogosim;

constexpr double kAreaPerRobotMm2 = 1e4;
constexpr double kWarmUpS = 8.0;                 // simulated: the flash of light and the boot of hanabi are over
constexpr std::int64_t kRobotSteps = 2'000'000;  // measured in each run
constexpr std::string_view kConfiguration = POGOSIM_BENCH_CONFIGURATION;  // conf/....yaml
constexpr bool kSharesNothing = POGOSIM_BENCH_SHARES_NOTHING;  // its robots, as the simulator finds out otherwise
constexpr bool kHasMembranes = kConfiguration == "walls_and_membranes";
constexpr int kRobotsPerMembrane = 100;

struct Result {
    double seconds = 0.0;  // wall clock
    std::int64_t steps = 0;
    double time_step_s = 0.0;
    std::array<double, kStageNames.size()> stage_s{};
    double bytes_per_robot = 0.0;
    std::uint64_t hash = 0;
};

/// Bytes of memory in use by this process.
double resident_bytes() {
    long pages_total = 0;
    long pages_resident = 0;
    std::ifstream("/proc/self/statm") >> pages_total >> pages_resident;
    return static_cast<double>(pages_resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

struct Options {
    bool json = false;
    int runs = 3;                        // of which the best one counts
    std::vector<int> sizes;              // numbers of robots
    std::vector<std::string> overrides;  // of the configuration
};

Scenario scenario_of(int robots, std::vector<std::string> const& overrides) {
    std::string const source = POGOSIM_SOURCE_DIR;
    std::vector<std::string> all{fmt::format("objects.robots.nb={}", robots),
                                 fmt::format("arena_surface={}", robots * kAreaPerRobotMm2),
                                 "arena_file=" + source + "/arenas/square.csv",
                                 "initial_formation=random",
                                 "enable_data_logging=false",
                                 "enable_console_logging=false",
                                 "save_video_period=-1",
                                 "seed=1"};
    if (kHasMembranes) {
        all.push_back(fmt::format("objects.membranes.nb={}", std::max(robots / kRobotsPerMembrane, 1)));
        all.push_back("initial_formation=power_lloyd");
    }
    all.insert(all.end(), overrides.begin(), overrides.end());
    return load_scenario(fmt::format("{}/conf/{}.yaml", source, kConfiguration), {.overrides = all, .strict = true},
                         object_types());
}

void step_or_die(Simulation& simulation) {
    if (auto const failure = simulation.step()) {
        throw std::runtime_error(failure->what);
    }
}

void warm_up(Simulation& simulation) {
    if (auto const failure = simulation.start()) {
        throw std::runtime_error(failure->what);
    }
    while (simulation.world().time_s() < kWarmUpS) {
        step_or_die(simulation);
    }
}

/// The memory of the smallest swarm includes all code and libraries; it is subtracted from the memory of the others.
void load_code(Options const& options) {
    Simulation simulation(linked_program(pogosim_this_program, "bench"),
                          scenario_of(kHasMembranes ? kRobotsPerMembrane : 1, options.overrides), {});
    warm_up(simulation);
}

Result run_once(int robots, Options const& options) {
    double const bytes_before = resident_bytes();
    Simulation simulation(linked_program(pogosim_this_program, "bench"), scenario_of(robots, options.overrides),
                          {.measure_stages = true, .shares_nothing = kSharesNothing});
    CrashHandlerScope const thread(simulation.crash_handler());  // as of a whole run, not of each step
    warm_up(simulation);
    StageClock const warm = simulation.stages();
    Result result;
    result.steps = std::max<std::int64_t>(kRobotSteps / robots, 1);
    auto const begin = std::chrono::steady_clock::now();
    for (std::int64_t i = 0; i < result.steps; ++i) {
        step_or_die(simulation);
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    for (std::size_t s = 0; s < kStageNames.size(); ++s) {
        result.stage_s[s] = simulation.stages().spent_s(static_cast<Stage>(s)) - warm.spent_s(static_cast<Stage>(s));
    }
    result.bytes_per_robot =
        (resident_bytes() - bytes_before) / robots - static_cast<double>(*pogosim_this_program.user_data_bytes);
    result.hash = simulation.hash();
    result.time_step_s = simulation.world().time_step_s;
    return result;
}

void print_header() {
    fmt::print("{:>7} {:>12} {:>16} {:>12}   ", "robots", "x real time", "us/robot/step", "kB/robot");
    for (auto const name : kStageNames) {
        fmt::print("{:>10}", name);
    }
    fmt::print("   hash\n");
}

void print(int robots, Result const& best) {
    double const step_s = best.seconds / static_cast<double>(best.steps);
    fmt::print("{:>7} {:>12.1f} {:>16.3f} {:>12.2f}   ", robots, best.time_step_s / step_s, 1e6 * step_s / robots,
               best.bytes_per_robot / 1000.0);
    for (double const stage_s : best.stage_s) {
        fmt::print("{:>8.1f} %", 100.0 * stage_s / best.seconds);
    }
    fmt::print("   {:016x}\n", best.hash);
}

void print_json(int robots, Result const& best) {
    double const step_s = best.seconds / static_cast<double>(best.steps);
    fmt::print(
        R"({{"robots": {}, "times_real_time": {}, "us_per_robot_and_step": {}, "kb_per_robot": {}, "hash": "{:016x}")",
        robots, best.time_step_s / step_s, 1e6 * step_s / robots, best.bytes_per_robot / 1000.0, best.hash);
    for (std::size_t s = 0; s < kStageNames.size(); ++s) {
        fmt::print(R"(, "share_of_{}": {})", kStageNames[s], best.stage_s[s] / best.seconds);
    }
    fmt::print("}}\n");
    std::fflush(stdout);
}

constexpr int kMostRobots = 10'000'000;

std::string usage(char const* program) {
    return fmt::format("Usage: {} [--json] [--runs N] [--set KEY=VALUE] ... [number of robots, 1 to {} ...]", program,
                       kMostRobots);
}

/// Throws when the arguments are wrong.
Options options_of(int argc, char** argv) {
    auto const fail = [&](std::string const& what) {
        throw std::runtime_error(fmt::format("{}\n{}", what, usage(argv[0])));
    };
    Options options;
    for (int i = 1; i < argc; ++i) {
        std::string const argument = argv[i];
        if (argument == "--set" && i + 1 < argc) {
            options.overrides.emplace_back(argv[++i]);
            continue;
        }
        if (argument == "--json") {
            options.json = true;
            continue;
        }
        if (argument == "--runs" && i + 1 < argc) {
            options.runs = std::atoi(argv[++i]);
            if (options.runs < 1) {
                fail(fmt::format("'{}' is no number of runs", argv[i]));
            }
            continue;
        }
        int const robots = std::atoi(argument.c_str());
        if (robots < 1 || robots > kMostRobots) {
            fail(fmt::format("'{}' is no number of robots", argument));
        }
        options.sizes.push_back(robots);
    }
    if (options.sizes.empty()) {
        options.sizes = {100, 1000, 10000};
    }
    return options;
}

void measure(Options const& options) {
    if (!options.json) {
        print_header();
    }
    load_code(options);
    for (int const robots : options.sizes) {
        Result best = run_once(robots, options);
        for (int run = 1; run < options.runs; ++run) {
            Result const next = run_once(robots, options);
            if (next.hash != best.hash) {
                throw std::runtime_error(fmt::format("two runs of {} robots end in different states", robots));
            }
            // The first run says most about memory: later ones find some already there.
            double const bytes = best.bytes_per_robot;
            best = next.seconds < best.seconds ? next : best;
            best.bytes_per_robot = bytes;
        }
        options.json ? print_json(robots, best) : print(robots, best);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h")) {
        fmt::print("{}\n", usage(argv[0]));
        return EXIT_SUCCESS;
    }
    start_logging({.quiet = true, .file = {}});
    try {
        measure(options_of(argc, argv));
    } catch (std::exception const& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    }
    return EXIT_SUCCESS;
}
