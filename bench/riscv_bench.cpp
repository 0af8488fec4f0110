// How many instructions of the robot's processor are executed in a second, on one core, with their cycles counted.
//
//     build/release/bench/bench_riscv
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "riscv/core.hpp"
#include "riscv/firmware_file.hpp"
#include "riscv/program/workloads.h"

namespace {

using namespace pogosim;
constexpr int kRuns = 5;
constexpr std::uint64_t kAtOnce = 1'000'000'000'000;

struct Workload {
    std::string name;
    std::uint32_t which;
    std::uint32_t count;
};

std::string bytes_of(char const* file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Does a workload from the beginning, in pieces of so many cycles.
Core run_all(Firmware const& firmware, Workload const& work, std::uint64_t cycles) {
    Memory memory(firmware.image);
    Core core{.x = {}, .pc = firmware.entry};
    core.x[10] = work.which;  // registers of the first two arguments
    core.x[11] = work.count;
    Stop stop;
    do {
        stop = run(core, memory, firmware.code, cycles);
    } while (stop.reason == StopReason::budget_used);
    if (stop.reason != StopReason::ecall || core.x[10] != workload(work.which, work.count)) {
        throw std::runtime_error(fmt::format("{}: a wrong result, or stopped at {:#x}", work.name, stop.pc));
    }
    return core;
}

/// `counting`: the same firmware with a cycle for each instruction.
void measure(Firmware const& firmware, Firmware const& counting, Workload const& work) {
    auto const instructions = static_cast<double>(run_all(counting, work, kAtOnce).cycles);
    std::uint64_t const cycles = run_all(firmware, work, kAtOnce).cycles;
    // A robot's step of 10 ms is 210 000 cycles.
    for (std::uint64_t const piece : {kAtOnce, std::uint64_t{210'000}, std::uint64_t{2'100}}) {
        double least_s = 1e9;
        for (int i = 0; i < kRuns; ++i) {
            std::clock_t const begin = std::clock();  // time of the processor: others may use the machine, too
            run_all(firmware, work, piece);
            least_s = std::min(least_s, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
        }
        fmt::print("{:8} {:>14} cycles a piece  {:7.1f} million instructions per s  {:5.2f} cycles per instruction\n",
                   work.name, piece, instructions / least_s * 1e-6, static_cast<double>(cycles) / instructions);
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        char const* const file = argc > 1 ? argv[1] : POGOSIM_BENCH_WORKLOADS;
        std::string const bytes = bytes_of(file);
        std::span const all = std::as_bytes(std::span(bytes));
        Firmware const firmware = read_firmware(file, all);
        Firmware const counting = read_firmware(file, all, {}, {1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0});
        for (Workload const& work : {Workload{"crc", kCrc, 1'000'000}, Workload{"floats", kFloats, 300'000},
                                     Workload{"sort", kSort, 200}, Workload{"mixture", kMixture, 50'000}}) {
            measure(firmware, counting, work);
        }
    } catch (std::exception const& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
