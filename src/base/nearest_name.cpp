#include "base/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <vector>

namespace pogosim {

namespace {

bool same_letter(char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

// In long names, a third is a word: run_duration_min is no slip of turn_duration_ms.
bool is_misspelling(std::string_view typed, std::string_view name, std::size_t distance) {
    constexpr std::size_t kMostLetters = 3;
    return distance <= kMostLetters && 3 * distance <= std::min(typed.size(), name.size());
}

/// The only one that is what was typed and a unit, such as angle_deg for angle; empty: there is none.
std::string name_with_unit(std::string_view typed, std::span<std::string const> known) {
    constexpr std::size_t kLongestUnit = 6;  // "_rad_s"
    std::string found;
    for (std::string const& name : known) {
        bool const begins = !typed.empty() && name.starts_with(typed) && name.substr(typed.size()).starts_with('_');
        if (begins && name.size() - typed.size() <= kLongestUnit) {
            if (!found.empty()) {
                return "";
            }
            found = name;
        }
    }
    return found;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> previous(b.size() + 1);
    std::vector<std::size_t> current(b.size() + 1);
    std::iota(previous.begin(), previous.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        current[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            std::size_t const substituted = previous[j] + (same_letter(a[i], b[j]) ? 0 : 1);
            current[j + 1] = std::min({substituted, previous[j + 1] + 1, current[j] + 1});
        }
        std::swap(previous, current);
    }
    return previous[b.size()];
}

std::string nearest_name(std::string_view typed, std::span<std::string const> known) {
    std::string best;
    std::size_t best_distance = 0;
    for (std::string const& name : known) {
        std::size_t const distance = edit_distance(typed, name);
        if (is_misspelling(typed, name, distance) && (best.empty() || distance < best_distance)) {
            best = name;
            best_distance = distance;
        }
    }
    return best;
}

std::string did_you_mean(std::string_view typed, std::span<std::string const> known) {
    std::string nearest = nearest_name(typed, known);
    if (nearest.empty()) {
        nearest = name_with_unit(typed, known);
    }
    return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

}  // namespace pogosim
