// Values of a program's variables as text.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "process/program_variables.hpp"

namespace pogosim {

using NamedTexts = std::vector<std::pair<std::string, std::string>>;

/// "3", "-0.25", "true", "RED", "{x: 1, y: 2}", "1, 2, 3, 4, 5, 6, 7, 8, ... (64)", "\"abc\"". `bytes`: as many as the
/// type has; of fewer, "?".
std::string value_text(VariableType const& type, std::span<std::byte const> bytes);

/// A variable as lines of a table: a structure has one for each member, "pose.x", others have one.
void add_texts(std::string const& name, VariableType const& type, std::span<std::byte const> bytes, NamedTexts& texts);

}  // namespace pogosim
