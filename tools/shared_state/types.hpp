// Types in a program's debug information.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "debug_info/entries.hpp"

namespace shared_state {

bool is_structure(Dwarf_Die* type);

/// A structure, or a name for a type.
bool is_type(Dwarf_Die* declaration);

/// Also a reference.
bool is_pointer(Dwarf_Die* type);

/// What `[i]` and `*` make of a type. Rows of an array stay an array.
std::optional<Dwarf_Die> element(std::optional<Dwarf_Die> type);

/// Without typedef, const and references.
std::optional<Dwarf_Die> unnamed(std::optional<Dwarf_Die> type);

bool is_array(Dwarf_Die* type);

/// What a type is in the end, without names, const, arrays and the like; with pointers or through them.
struct Basic {
    Dwarf_Die type;
    std::vector<std::string> names;  ///< of typedefs, the outermost first
};

std::optional<Basic> basic_type(std::optional<Dwarf_Die> type, bool through_pointers);

/// The name that a program uses for it.
std::string name_of(Basic& basic);

}  // namespace shared_state
