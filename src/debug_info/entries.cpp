#include "debug_info/entries.hpp"

#include <dwarf.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>

namespace shared_state {

DebugFile::DebugFile(std::string const& path)
    : descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC)),
      dwarf_(descriptor_ >= 0 ? dwarf_begin(descriptor_, DWARF_C_READ) : nullptr) {}

DebugFile::~DebugFile() {
    dwarf_end(dwarf_);
    if (is_open()) {
        close(descriptor_);
    }
}

std::string name_of(Dwarf_Die* entry) {
    char const* const name = dwarf_diename(entry);
    return name ? name : "";
}

std::optional<Dwarf_Die> type_of(Dwarf_Die* entry) {
    Dwarf_Attribute attribute;
    Dwarf_Die type;
    bool const has_type = dwarf_attr_integrate(entry, DW_AT_type, &attribute) && dwarf_formref_die(&attribute, &type);
    return has_type ? std::optional(type) : std::nullopt;
}

std::vector<Dwarf_Die> ScopeFinder::scopes_around(Dwarf_Die entry) {
    Dwarf_Off const offset = dwarf_dieoffset(&entry);
    std::vector<Dwarf_Die> scopes;
    Dwarf_Die scope;
    bool found = dwarf_diecu(&entry, &scope, nullptr, nullptr) != nullptr;
    while (found && dwarf_dieoffset(&scope) < offset) {
        scopes.push_back(scope);
        // Entries are stored depth first: the entry is in the last child that does not begin after it.
        auto const begins_after = [](Dwarf_Off at, Dwarf_Die child) { return at < dwarf_dieoffset(&child); };
        auto const& children = children_of(&scope);
        auto const next = std::upper_bound(children.begin(), children.end(), offset, begins_after);
        found = next != children.begin();
        if (found) {
            scope = *std::prev(next);
        }
    }
    return scopes;
}

std::vector<Dwarf_Die> const& ScopeFinder::children_of(Dwarf_Die* scope) {
    auto const [place, is_new] = children_.try_emplace(dwarf_dieoffset(scope));
    std::vector<Dwarf_Die>& children = place->second;
    if (is_new) {
        for_each_child(scope, [&](Dwarf_Die const& child) { children.push_back(child); });
    }
    return children;
}

}  // namespace shared_state
