// How long it takes to build a very large swarm and to step it, and how much memory that needs.
//
//     build/release/bench/bench_large [number of robots, formation] ...
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

#include "base/log.hpp"
#include "config/scenario.hpp"
#include "lamps/lamp_types.hpp"
#include "sim/simulation.hpp"

namespace {

using namespace pogosim;

constexpr double kAreaPerRobotMm2 = 1e4;
constexpr int kRobotSteps = 5'000'000;  // measured

/// Processor time, which does not count other programs on the machine.
double now_s() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double resident_bytes() {
    long pages_total = 0;
    long pages_resident = 0;
    std::ifstream("/proc/self/statm") >> pages_total >> pages_resident;
    return static_cast<double>(pages_resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

Scenario scenario_of(std::string const& robots, std::string const& formation) {
    std::string const source = POGOSIM_SOURCE_DIR;
    double const area_mm2 = std::atof(robots.c_str()) * kAreaPerRobotMm2;
    return load_scenario(source + "/conf/simple.yaml",
                         {.overrides = {"objects.robots.nb=" + robots, fmt::format("arena_surface={}", area_mm2),
                                        "arena_file=" + source + "/arenas/square.csv", "initial_formation=" + formation,
                                        "chessboard_distance_between_neighbors=90", "enable_data_logging=false",
                                        "enable_console_logging=false", "save_video_period=-1", "seed=1"},
                          .strict = false},
                         object_types());
}

bool measure(std::string const& robots, std::string const& formation) {
    double const bytes_before = resident_bytes();
    double const begin_s = now_s();
    Simulation simulation(linked_program(pogosim_this_program, "bench"), scenario_of(robots, formation),
                          {.measure_stages = true});
    double const built_s = now_s();
    if (auto const failure = simulation.start()) {
        fmt::print(stderr, "{}\n", failure->what);
        return false;
    }
    double const started_s = now_s();
    if (simulation.step()) {  // the first one has new contacts only
        return false;
    }
    double const warm_s = now_s();
    int const steps = std::max(kRobotSteps / static_cast<int>(simulation.world().robots.size()), 1);
    for (int i = 0; i < steps; ++i) {
        if (auto const failure = simulation.step()) {
            fmt::print(stderr, "{}\n", failure->what);
            return false;
        }
    }
    double const stepped_s = now_s();
    auto const count = static_cast<double>(simulation.world().robots.size());
    fmt::print("{:>9} {:>12} {:>9.2f} {:>9.2f} {:>11.2f} {:>11.3f} {:>15.3f} {:>10.2f}\n", robots, formation,
               built_s - begin_s, started_s - built_s, warm_s - started_s, (stepped_s - warm_s) / steps,
               1e6 * (stepped_s - warm_s) / steps / count, (resident_bytes() - bytes_before) / count / 1000.0);
    std::fflush(stdout);
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    start_logging({.quiet = true, .file = {}});
    if (argc % 2 == 0) {
        fmt::print(stderr, "Usage: {} [number of robots, formation] ...\n", argv[0]);
        return 2;
    }
    fmt::print("{:>9} {:>12} {:>9} {:>9} {:>11} {:>11} {:>15} {:>10}\n", "robots", "formation", "build s", "start s",
               "1st step s", "s per step", "us/robot/step", "kB/robot");
    if (argc == 1) {
        return measure("1000000", "random") ? EXIT_SUCCESS : EXIT_FAILURE;
    }
    for (int i = 1; i + 1 < argc; i += 2) {
        if (!measure(argv[i], argv[i + 1])) {
            return EXIT_FAILURE;
        }
    }
    return EXIT_SUCCESS;
}
