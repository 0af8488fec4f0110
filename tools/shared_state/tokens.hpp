// C and C++ text as the words and operators that it is made of.
#pragma once

#include <string>
#include <vector>

namespace shared_state {

using Tokens = std::vector<std::string>;

Tokens tokens_of(std::string const& text);

/// Arguments of a call. Commas in brackets belong to one of them.
std::vector<Tokens> split_at_commas(Tokens const& tokens);

bool is_name(std::string const& token);

/// A number or a text.
bool is_constant(std::string const& token);

}  // namespace shared_state
