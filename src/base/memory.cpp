#include "base/memory.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>

#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 33)
#include <malloc.h>
#define POGOSIM_HAS_MALLINFO2
#endif
#endif
#ifdef __APPLE__
#include <malloc/malloc.h>
#endif

namespace pogosim {

namespace {

std::string size_text(double bytes) {
    constexpr std::array kUnits{"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
    constexpr double kStep = 1024.0;
    std::size_t unit = 0;
    for (; bytes >= kStep && unit + 1 < kUnits.size(); ++unit) {
        bytes /= kStep;
    }
    return fmt::format("{:.{}f} {}", bytes, unit == 0 ? 0 : 1, kUnits[unit]);
}

}  // namespace

void fail_for_memory(std::string const& purpose, std::optional<double> bytes) {
    throw OutOfMemory(fmt::format(
        "not enough memory for {}{}; reduce it, or raise this run's memory limit (ulimit -v, or the batch system's)",
        purpose, bytes ? ", " + size_text(*bytes) : ""));
}

std::size_t allocated_bytes() {
#ifdef POGOSIM_HAS_MALLINFO2
    auto const info = mallinfo2();
    return info.uordblks + info.hblkhd;
#elif defined(__APPLE__)
    return mstats().bytes_used;
#else
    return 0;
#endif
}

}  // namespace pogosim
