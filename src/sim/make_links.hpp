// The links of a configuration, between bodies that stand at their places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/vec2.hpp"
#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Appends the links of the scenario to the world: entry after entry, those of an entry in the order of their objects.
/// Throws ConfigError.
void make_links(Scenario const& scenario, World& world);

// The CSV files that entries of `links` name.

/// A row of a file for `topology: list`: columns a, b and optionally length.
struct ListedLink {
    std::uint32_t a = 0;  // numbers of objects within their category
    std::uint32_t b = 0;
    std::optional<float> length_mm;
    std::string where;  // "links.csv:3", for messages
};

/// A row of a file for `topology: fixed`: columns a, x and y.
struct ListedPlace {
    std::uint32_t a = 0;
    Vec2 place_mm;
    std::string where;
};

/// Both take a header with these names in any order, or columns in this order without one; they throw ConfigError with
/// file and line for anything else, and for a number that is not below its count.
std::vector<ListedLink> read_listed_links(std::filesystem::path const& file, std::size_t count_a, std::size_t count_b);
std::vector<ListedPlace> read_listed_places(std::filesystem::path const& file, std::size_t count);

}  // namespace pogosim
