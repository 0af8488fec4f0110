// What this machine can do at most, on one core: bytes per second from and to memory, and floating-point operations per
// second, as compiled for any x86-64 processor. To compare with what a step needs, see docs/performance.md.
//
//     build/release/bench/bench_machine
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRuns = 5;

/// Least seconds that a call takes, of some.
template <class Work>
double least_s(Work const& work) {
    double least = 1e9;
    for (int run = 0; run < kRuns; ++run) {
        auto const begin = Clock::now();
        work();
        least = std::min(least, std::chrono::duration<double>(Clock::now() - begin).count());
    }
    return least;
}

/// The "triad" of J. D. McCalpin, "Memory bandwidth and machine balance in current high performance computers", IEEE
/// TCCA Newsletter (1995): two arrays are read, one is written. Bytes per second.
double memory_bytes_per_s(std::size_t count) {
    std::vector<float> a(count, 1.0F);
    std::vector<float> b(count, 2.0F);
    std::vector<float> c(count, 3.0F);
    std::size_t const times = std::max<std::size_t>(100'000'000 / count, 1);
    double const seconds = least_s([&] {
        for (std::size_t k = 0; k < times; ++k) {
            auto const factor = static_cast<float>(k);
            for (std::size_t i = 0; i < count; ++i) {
                a[i] = b[i] + factor * c[i];
            }
            asm volatile("" : : "r"(a.data()) : "memory");
        }
    });
    return 3.0 * sizeof(float) * static_cast<double>(count * times) / seconds;
}

/// Multiplications and additions of independent chains: as many as registers hold, one number at a time or four.
template <std::size_t Chains>
double operations_per_s() {
    constexpr std::size_t kTimes = 20'000'000;
    std::array<float, Chains> numbers{};
    double const seconds = least_s([&] {
        std::array<float, Chains> x = numbers;
        for (std::size_t k = 0; k < kTimes; ++k) {
            for (float& number : x) {
                number = number * 0.999F + 0.5F;
            }
        }
        numbers = x;
        asm volatile("" : : "r"(numbers.data()) : "memory");
    });
    return 2.0 * Chains * kTimes / seconds;
}

/// Square roots and divisions, one after the other, as in a contact: pairs per second.
double roots_per_s() {
    constexpr std::size_t kTimes = 20'000'000;
    volatile float start = 2.0F;
    double const seconds = least_s([&] {
        float x = start;
        for (std::size_t k = 0; k < kTimes; ++k) {
            x = 1.5F / std::sqrt(x + 1.0F);
        }
        start = x;
    });
    return kTimes / seconds;
}

}  // namespace

int main() {
    fmt::print("memory, 400 MB:              {:.1f} GB/s\n", 1e-9 * memory_bytes_per_s(100'000'000 / 3));
    fmt::print("second-level cache, 200 kB:  {:.1f} GB/s\n", 1e-9 * memory_bytes_per_s(50'000 / 3));
    fmt::print("one chain of operations:     {:.2f} G/s\n", 1e-9 * operations_per_s<1>());
    fmt::print("sixteen, four at a time:     {:.2f} G/s\n", 1e-9 * operations_per_s<16>());
    fmt::print("root and division, a chain:  {:.3f} G/s\n", 1e-9 * roots_per_s());
    return 0;
}
