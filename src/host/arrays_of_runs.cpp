// Arrays of many runs, one after the other in memory of the host.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
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

/// The rows of an array of numbers; each is without gaps within itself.
struct Rows {
    std::byte* data;
    std::size_t count;
    std::ptrdiff_t stride_bytes;
    std::size_t bytes;  // of each

    std::byte* at(std::size_t row) const { return data + static_cast<std::ptrdiff_t>(row) * stride_bytes; }
    bool is_dense() const { return stride_bytes == static_cast<std::ptrdiff_t>(bytes); }
};

Rows rows_of(pogosim_array const& array) {
    std::size_t bytes = 0;  // of a value: "<f4", "|V48"
    std::from_chars(array.type + 2, std::end(array.type), bytes);
    for (int i = 1; i < array.dimensions; ++i) {
        bytes *= static_cast<std::size_t>(array.shape[i]);
    }
    return {.data = static_cast<std::byte*>(const_cast<void*>(array.data)),
            .count = static_cast<std::size_t>(array.shape[0]),
            .stride_bytes = array.stride_bytes[0],
            .bytes = bytes};
}

void check_size(std::size_t run, std::size_t rows, std::size_t bytes_of_row, std::size_t bytes) {
    if (rows * bytes_of_row != bytes) {
        throw ConfigError(fmt::format("run {}: the array has {} rows of {} bytes, and there is room for {} bytes", run,
                                      rows, bytes_of_row, bytes));
    }
}

/// All arrays of bodies are of such numbers.
void fill_absent(std::byte* row, std::size_t bytes) {
    float const nan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t at = 0; at < bytes; at += sizeof(nan)) {
        std::memcpy(row + at, &nan, sizeof(nan));
    }
}

void read_bodies(std::size_t run, World const& world, Rows const& rows, std::byte* into, std::size_t bytes) {
    std::span const bodies(world.robots.body.data(), world.robots.size());
    check_size(run, bodies.size(), rows.bytes, bytes);
    for (std::uint32_t const body : bodies) {
        if (body == kNone) {
            fill_absent(into, rows.bytes);
        } else {
            std::memcpy(into, rows.at(body), rows.bytes);
        }
        into += rows.bytes;
    }
}

void read_light(std::size_t run, World const& world, std::byte* into, std::size_t bytes) {
    std::vector<double> levels(world.robots.size());
    check_size(run, levels.size(), sizeof(double), bytes);
    read_light_levels(world, levels.data());
    std::memcpy(into, levels.data(), bytes);
}

void read_number(std::size_t run, double value, std::byte* into, std::size_t bytes) {
    check_size(run, 1, sizeof(value), bytes);
    std::memcpy(into, &value, sizeof(value));
}

void read_rows(std::size_t run, Rows const& rows, std::byte* into, std::size_t bytes) {
    check_size(run, rows.count, rows.bytes, bytes);
    if (rows.is_dense() && bytes > 0) {
        std::memcpy(into, rows.data, bytes);
        return;
    }
    for (std::size_t row = 0; row < rows.count; ++row) {
        std::memcpy(into + row * rows.bytes, rows.at(row), rows.bytes);
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

std::byte* place_of(std::size_t run, pogosim_exchange const& exchange) {
    return static_cast<std::byte*>(exchange.place) + run * exchange.bytes_each;
}

}  // namespace

/// All arrays that may be written are dense.
void pogosim::give_array(pogosim_run& run, std::size_t index, pogosim_exchange const& exchange) {
    if (std::ranges::find(kWritten, std::string_view(exchange.name)) == kWritten.end()) {
        throw ConfigError(fmt::format("the array '{}' cannot be written", exchange.name));
    }
    Rows const rows = rows_of(brain_array_of(run, exchange.category, exchange.name));
    check_size(index, rows.count, rows.bytes, exchange.bytes_each);
    if (exchange.bytes_each > 0) {
        std::memcpy(rows.data, place_of(index, exchange), exchange.bytes_each);
    }
}

void pogosim::take_array(pogosim_run& run, std::size_t index, pogosim_exchange const& exchange) {
    Rows const rows = rows_of(brain_array_of(run, exchange.category, exchange.name));
    read_rows(index, rows, place_of(index, exchange), exchange.bytes_each);
}

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
            if (std::optional<double> const value = number_of(*runs[i], name); value && category == nullptr) {
                read_number(i, *value, place, bytes_each);
                continue;
            }
            Rows const rows = rows_of(array_in(*runs[i], category, name));
            if (of_bodies) {
                read_bodies(i, runs[i]->simulation().world(), rows, place, bytes_each);
            } else {
                read_rows(i, rows, place, bytes_each);
            }
        }
        return POGOSIM_OK;
    });
}
