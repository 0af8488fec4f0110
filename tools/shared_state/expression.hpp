// Which object an expression of C or C++ points to, and whose size it is: as much of the grammar as the arguments of a
// call need. An expression that cannot be followed means no object, rather than a wrong one.
#pragma once

#include <elfutils/libdw.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "value.hpp"

namespace shared_state {

struct Expression {
    Values values;
    Values sizes;  ///< what `sizeof` is taken of, anywhere in it
};

/// The declaration that a name means: of a variable or a type.
using FindName = std::function<std::optional<Dwarf_Die>(std::string const& name)>;

/// Arguments of a call, one expression each.
std::vector<Expression> read_arguments(std::string const& text, FindName const& find_name);

}  // namespace shared_state
