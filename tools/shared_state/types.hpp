// Types in a program's debug information.
#pragma once

#include <elfutils/libdw.h>

#include <optional>
#include <string>
#include <vector>

namespace shared_state {

std::string name_of(Dwarf_Die* entry);

/// The type of a variable or member; what a typedef, an array or a pointer is made of.
std::optional<Dwarf_Die> type_of(Dwarf_Die* entry);

bool is_structure(Dwarf_Die* type);

/// Also a reference.
bool is_pointer(Dwarf_Die* type);

/// What a type is in the end, without names, const, arrays and the like; with pointers or through them.
struct Basic {
    Dwarf_Die type;
    std::vector<std::string> names;  ///< of typedefs, the outermost first
};

std::optional<Basic> basic_type(std::optional<Dwarf_Die> type, bool through_pointers);

/// The name that a program uses for it.
std::string name_of(Basic& basic);

template <class See>
void for_each_child(Dwarf_Die* parent, See const& see) {
    Dwarf_Die child;
    if (dwarf_child(parent, &child) == 0) {
        do {
            see(child);
        } while (dwarf_siblingof(&child, &child) == 0);
    }
}

}  // namespace shared_state
