#include "physics/coinciding_centres.hpp"

#include <algorithm>
#include <numeric>

namespace pogosim {

void part_coinciding_centres(std::vector<Vec2>& position_mm, std::span<std::uint32_t const> moved) {
    std::vector<std::uint32_t> by_x(position_mm.size());
    std::iota(by_x.begin(), by_x.end(), 0U);
    auto const x_of = [&](std::uint32_t body) { return position_mm[body].x; };
    std::ranges::sort(by_x, {}, x_of);
    std::vector<Vec2> const before = position_mm;
    auto const x_before = [&](std::uint32_t body) { return before[body].x; };
    for (std::uint32_t const body : moved) {
        Vec2 const place = before[body];
        int others = 0;  // at the same place: those that stay there, and those moved by fewer multiples
        for (auto next = std::ranges::lower_bound(by_x, place.x - kApartMm, {}, x_before);
             next != by_x.end() && x_before(*next) <= place.x + kApartMm; ++next) {
            bool const goes_first = *next < body || !std::ranges::binary_search(moved, *next);
            if (*next != body && goes_first && squared_length(before[*next] - place) < kApartMm * kApartMm) {
                ++others;
            }
        }
        position_mm[body].x += static_cast<float>(others) * kApartMm;
    }
}

}  // namespace pogosim
