// How fast a swarm runs: an example program at 100, 1000 and 10000 robots on 10^4 mm2 each, headless, without a data
// file. Prints the real-time factor, microseconds per robot and step, the share of each stage, memory per robot, and a
// hash of the final state, which must not depend on the machine's load. Best of several runs, each after a warm-up.
//
//     build/release/bench/bench_run_and_tumble [number of robots ...]
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "base/log.hpp"
#include "config/scenario.hpp"
#include "sim/simulation.hpp"

namespace {

using namespace pogosim;

constexpr double kAreaPerRobotMm2 = 1e4;
constexpr double kWarmUpS = 8.0;                 // simulated: the flash of light and the boot of hanabi are over
constexpr std::int64_t kRobotSteps = 2'000'000;  // measured in each run
constexpr int kRuns = 3;

struct Result {
    double seconds = 0.0;  // wall clock
    std::int64_t steps = 0;
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

Scenario scenario_of(int robots) {
    std::string const source = POGOSIM_SOURCE_DIR;
    return load_scenario(
        source + "/conf/simple.yaml",
        {.overrides = {fmt::format("objects.robots.nb={}", robots),
                       fmt::format("arena_surface={}", robots * kAreaPerRobotMm2),
                       "arena_file=" + source + "/arenas/square.csv", "initial_formation=random",
                       "enable_data_logging=false", "enable_console_logging=false", "save_video_period=-1", "seed=1"},
         .strict = true});
}

void step_or_die(Simulation& simulation) {
    if (auto const failure = simulation.step()) {
        fmt::print(stderr, "{}\n", failure->what);
        std::exit(EXIT_FAILURE);
    }
}

void warm_up(Simulation& simulation) {
    if (auto const failure = simulation.start()) {
        fmt::print(stderr, "{}\n", failure->what);
        std::exit(EXIT_FAILURE);
    }
    while (simulation.world().time_s() < kWarmUpS) {
        step_or_die(simulation);
    }
}

/// A robot alone has all code and libraries loaded, which then counts for nobody's memory.
void load_code() {
    Simulation simulation(linked_program(pogosim_this_program, "bench"), scenario_of(1), {});
    warm_up(simulation);
}

Result run_once(int robots) {
    double const bytes_before = resident_bytes();
    Simulation simulation(linked_program(pogosim_this_program, "bench"), scenario_of(robots), {.measure_stages = true});
    GuardedThread const thread(simulation.guard());  // as of a whole run, not of each step
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
    return result;
}

void print(int robots, Result const& best) {
    double const step_s = best.seconds / static_cast<double>(best.steps);
    constexpr double kTimeStepS = 0.01;
    fmt::print("{:>7} {:>12.1f} {:>16.3f} {:>12.2f}   ", robots, kTimeStepS / step_s, 1e6 * step_s / robots,
               best.bytes_per_robot / 1000.0);
    for (double const stage_s : best.stage_s) {
        fmt::print("{:>8.1f} %", 100.0 * stage_s / best.seconds);
    }
    fmt::print("   {:016x}\n", best.hash);
}

}  // namespace

int main(int argc, char** argv) {
    start_logging({.quiet = true, .file = {}});
    std::vector<int> sizes;
    for (int i = 1; i < argc; ++i) {
        sizes.push_back(std::atoi(argv[i]));
    }
    if (std::any_of(sizes.begin(), sizes.end(), [](int n) { return n < 1 || n > 10'000'000; })) {
        fmt::print(stderr, "Usage: {} [number of robots, 1 to 10000000 ...]\n", argv[0]);
        return 2;
    }
    if (sizes.empty()) {
        sizes = {100, 1000, 10000};
    }
    fmt::print("{:>7} {:>12} {:>16} {:>12}   ", "robots", "x real time", "us/robot/step", "kB/robot");
    for (auto const name : kStageNames) {
        fmt::print("{:>10}", name);
    }
    fmt::print("   hash\n");
    load_code();
    for (int const robots : sizes) {
        Result best = run_once(robots);
        for (int run = 1; run < kRuns; ++run) {
            Result const next = run_once(robots);
            if (next.hash != best.hash) {
                fmt::print(stderr, "two runs of {} robots end in different states\n", robots);
                return EXIT_FAILURE;
            }
            // The first run says most about memory: later ones find some already there.
            double const bytes = best.bytes_per_robot;
            best = next.seconds < best.seconds ? next : best;
            best.bytes_per_robot = bytes;
        }
        print(robots, best);
    }
    return EXIT_SUCCESS;
}
