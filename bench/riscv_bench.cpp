// How many instructions of the robot's processor are executed in a second, on one core, with their cycles counted.
//
//     build/release/bench/bench_riscv
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "riscv/core.hpp"
#include "riscv/program/workloads.h"

namespace {

using namespace pogosim;
constexpr int kRuns = 5;
constexpr std::uint64_t kAtOnce = 1'000'000'000'000;
constexpr std::size_t kCodeBytes = 0x4000;  // see tests/riscv/program/memory.ld

struct Workload {
    std::string name;
    std::uint32_t which;
    std::uint32_t count;
};

std::shared_ptr<MemoryImage const> read_image(char const* file) {
    std::ifstream stream(file, std::ios::binary);
    std::string const bytes{std::istreambuf_iterator<char>(stream), {}};
    if (bytes.empty() || bytes.size() > kMemoryBytes) {
        throw std::runtime_error(fmt::format("{} is no image of a robot's memory", file));
    }
    MemoryImage image;
    std::ranges::transform(bytes, image.bytes.begin(), [](char byte) { return static_cast<std::byte>(byte); });
    return std::make_shared<MemoryImage const>(std::move(image));
}

/// Does a workload from the beginning, in pieces of so many cycles.
Core run_all(std::shared_ptr<MemoryImage const> const& image, Code const& code, Workload const& work,
             std::uint64_t cycles) {
    Memory memory(image);
    Core core;
    core.x[10] = work.which;  // registers of the first two arguments
    core.x[11] = work.count;
    Stop stop;
    do {
        stop = run(core, memory, code, cycles);
    } while (stop.reason == StopReason::budget_used);
    if (stop.reason != StopReason::ecall || core.x[10] != workload(work.which, work.count)) {
        throw std::runtime_error(fmt::format("{}: a wrong result, or stopped at {:#x}", work.name, stop.pc));
    }
    return core;
}

void measure(std::shared_ptr<MemoryImage const> const& image, Workload const& work) {
    std::span const bytes(image->bytes.data(), kCodeBytes);
    // With a cycle each, cycles are instructions.
    Code const code = decode_code(0, bytes);
    Code counting = decode_code(0, bytes, {1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1});
    auto const instructions = static_cast<double>(run_all(image, counting, work, kAtOnce).cycles);
    std::uint64_t const cycles = run_all(image, code, work, kAtOnce).cycles;
    // A robot's step of 10 ms is 210 000 cycles.
    for (std::uint64_t const piece : {kAtOnce, std::uint64_t{210'000}, std::uint64_t{2'100}}) {
        double least_s = 1e9;
        for (int i = 0; i < kRuns; ++i) {
            std::clock_t const begin = std::clock();  // time of the processor: others may use the machine, too
            run_all(image, code, work, piece);
            least_s = std::min(least_s, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
        }
        fmt::print("{:8} {:>14} cycles a piece  {:7.1f} million instructions per s  {:5.2f} cycles per instruction\n",
                   work.name, piece, instructions / least_s * 1e-6, static_cast<double>(cycles) / instructions);
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        auto const image = read_image(argc > 1 ? argv[1] : POGOSIM_BENCH_WORKLOADS);
        for (Workload const& work : {Workload{"crc", kCrc, 1'000'000}, Workload{"floats", kFloats, 300'000},
                                     Workload{"sort", kSort, 200}, Workload{"mixture", kMixture, 50'000}}) {
            measure(image, work);
        }
    } catch (std::exception const& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
