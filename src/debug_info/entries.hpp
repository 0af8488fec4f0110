// The tree of a program's debug information: its entries, their names and types.
#pragma once

#include <elfutils/libdw.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace shared_state {

/// A file while its debug information is read.
class DebugFile {
public:
    explicit DebugFile(std::string const& path);
    ~DebugFile();
    DebugFile(DebugFile const&) = delete;
    DebugFile& operator=(DebugFile const&) = delete;

    /// False if it cannot be; errno says why.
    bool is_open() const { return descriptor_ >= 0; }

    /// Null if the file cannot be opened, or has none.
    Dwarf* debug_info() const { return dwarf_; }

private:
    int descriptor_;
    Dwarf* dwarf_;
};

/// Empty if it has none.
std::string name_of(Dwarf_Die* entry);

/// The type of a variable or member; what a typedef, an array or a pointer is made of.
std::optional<Dwarf_Die> type_of(Dwarf_Die* entry);

/// Finds what is around an entry. Unlike dwarf_getscopes_die(), which reads all of a unit up to the entry each time, it
/// reads the entries of a scope once.
class ScopeFinder {
public:
    /// The scopes around an entry, from the unit inwards.
    std::vector<Dwarf_Die> scopes_around(Dwarf_Die entry);

    std::vector<Dwarf_Die> const& children_of(Dwarf_Die* scope);

private:
    std::map<Dwarf_Off, std::vector<Dwarf_Die>> children_;  // by the offset of the scope
};

template <class See>
void for_each_child(Dwarf_Die* parent, See const& see) {
    Dwarf_Die child;
    for (bool found = dwarf_child(parent, &child) == 0; found; found = dwarf_siblingof(&child, &child) == 0) {
        see(child);
    }
}

/// Units are what was compiled at a time: a source file with all it includes. Without debug information, there is none.
template <class See>
void for_each_unit(Dwarf* debug_info, See const& see) {
    Dwarf_CU* unit = nullptr;
    Dwarf_Die entry;
    while (debug_info && dwarf_get_units(debug_info, unit, &unit, nullptr, nullptr, &entry, nullptr) == 0) {
        see(entry);
    }
}

}  // namespace shared_state
