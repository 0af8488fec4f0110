// "Did you mean ...?": the known name closest to what was typed.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pogosim {

/// Levenshtein distance between two strings (insertions, deletions, substitutions), ignoring ASCII case.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The closest of `known`, or an empty string when nothing is close enough to be a misspelling: three letters have to
/// change at most, and a third of the shorter name.
std::string nearest_name(std::string_view typed, std::span<std::string const> known);

/// "; did you mean 'x'?", also for a name without its unit (`angle`: `angle_deg`); empty when nothing is close enough.
std::string did_you_mean(std::string_view typed, std::span<std::string const> known);

}  // namespace pogosim
