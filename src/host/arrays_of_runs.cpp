// Arrays of many runs, one after the other in memory of the host.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "host/array_places.hpp"
#include "host/hosted_run.hpp"
#include "host/status.hpp"

using namespace pogosim;

namespace {

constexpr std::string_view kOfBodies = "bodies.";
constexpr std::string_view kLightLevels = "light_levels";  // which are in no memory
constexpr std::array kWritten{"motors", "leds", "send_bytes", "send_length", "send_face"};

std::size_t bytes_of_value(pogosim_array const& array) {
    return static_cast<std::size_t>(std::strtoul(array.type + 2, nullptr, 10));
}

std::size_t values_in_row(pogosim_array const& array) {
    std::size_t values = 1;
    for (int i = 1; i < array.dimensions; ++i) {
        values *= static_cast<std::size_t>(array.shape[i]);
    }
    return values;
}

/// Rows are without gaps within themselves, in all arrays of a run.
std::size_t bytes_of_row(pogosim_array const& array) {
    return values_in_row(array) * bytes_of_value(array);
}

std::byte* row_of(pogosim_array const& array, std::int64_t row) {
    return static_cast<std::byte*>(const_cast<void*>(array.data)) + row * array.stride_bytes[0];
}

void check_size(std::size_t run, std::int64_t rows, pogosim_array const& array, std::size_t bytes) {
    if (static_cast<std::size_t>(rows) * bytes_of_row(array) != bytes) {
        throw ConfigError(fmt::format("run {}: the array has {} rows of {} bytes, and there is room for {} bytes", run,
                                      rows, bytes_of_row(array), bytes));
    }
}

/// All arrays of bodies are of such numbers.
void fill_absent(std::byte* row, pogosim_array const& array) {
    float const nan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < values_in_row(array); ++i) {
        std::memcpy(row + i * sizeof(nan), &nan, sizeof(nan));
    }
}

void read_bodies(std::size_t run, World const& world, pogosim_array const& array, std::byte* into, std::size_t bytes) {
    std::span const bodies(world.robots.body.data(), world.robots.size());
    check_size(run, static_cast<std::int64_t>(bodies.size()), array, bytes);
    for (std::uint32_t const body : bodies) {
        if (body == kNone) {
            fill_absent(into, array);
        } else {
            std::memcpy(into, row_of(array, body), bytes_of_row(array));
        }
        into += bytes_of_row(array);
    }
}

void read_light(std::size_t run, World const& world, std::byte* into, std::size_t bytes) {
    std::vector<double> levels(world.robots.size());
    check_size(run, static_cast<std::int64_t>(levels.size()), numbers(levels), bytes);
    read_light_levels(world, levels.data());
    std::memcpy(into, levels.data(), bytes);
}

void read_rows(std::size_t run, pogosim_array const& array, std::byte* into, std::size_t bytes) {
    check_size(run, array.shape[0], array, bytes);
    for (std::int64_t row = 0; row < array.shape[0]; ++row) {
        std::memcpy(into, row_of(array, row), bytes_of_row(array));
        into += bytes_of_row(array);
    }
}

void write_rows(std::size_t run, pogosim_array const& array, std::byte const* from, std::size_t bytes) {
    check_size(run, array.shape[0], array, bytes);
    for (std::int64_t row = 0; row < array.shape[0]; ++row) {
        std::memcpy(row_of(array, row), from, bytes_of_row(array));
        from += bytes_of_row(array);
    }
}

pogosim_array array_in(pogosim_run& run, char const* category, char const* name) {
    if (category != nullptr) {
        return brain_array_of(run, category, name);
    }
    std::optional<pogosim_array> const found = array_of(run.simulation(), name);
    if (found && std::string_view(found->type) != "text") {
        return *found;
    }
    throw ConfigError(fmt::format("a run has no array '{}'", name));
}

}  // namespace

int pogosim_runs_read(pogosim_run* const* runs, size_t count, char const* category, char const* name, void* into,
                      size_t bytes_each) {
    return with_status([&] {
        auto* place = static_cast<std::byte*>(into);
        bool const of_bodies = category == nullptr && std::string_view(name).starts_with(kOfBodies);
        for (std::size_t i = 0; i < count; ++i, place += bytes_each) {
            std::lock_guard const lock(runs[i]->in_use);
            if (category == nullptr && name == kLightLevels) {
                read_light(i, runs[i]->simulation().world(), place, bytes_each);
                continue;
            }
            pogosim_array const array = array_in(*runs[i], category, name);
            if (of_bodies) {
                read_bodies(i, runs[i]->simulation().world(), array, place, bytes_each);
            } else {
                read_rows(i, array, place, bytes_each);
            }
        }
        return POGOSIM_OK;
    });
}

int pogosim_runs_write(pogosim_run* const* runs, size_t count, char const* category, char const* name, void const* from,
                       size_t bytes_each) {
    return with_status([&] {
        if (category == nullptr || std::ranges::find(kWritten, std::string_view(name)) == kWritten.end()) {
            throw ConfigError(fmt::format("the array '{}' cannot be written", name));
        }
        auto const* place = static_cast<std::byte const*>(from);
        for (std::size_t i = 0; i < count; ++i, place += bytes_each) {
            std::lock_guard const lock(runs[i]->in_use);
            write_rows(i, brain_array_of(*runs[i], category, name), place, bytes_each);
        }
        return POGOSIM_OK;
    });
}
