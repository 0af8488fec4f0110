#include "types.hpp"

#include <dwarf.h>

namespace shared_state {

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

bool is_structure(Dwarf_Die* type) {
    int const tag = dwarf_tag(type);
    return tag == DW_TAG_structure_type || tag == DW_TAG_class_type || tag == DW_TAG_union_type;
}

bool is_pointer(Dwarf_Die* type) {
    int const tag = dwarf_tag(type);
    return tag == DW_TAG_pointer_type || tag == DW_TAG_reference_type || tag == DW_TAG_rvalue_reference_type;
}

std::optional<Basic> basic_type(std::optional<Dwarf_Die> type, bool through_pointers) {
    Basic found{};
    while (type) {
        found.type = *type;
        bool const is_base = dwarf_tag(&*type) == DW_TAG_base_type || is_structure(&*type);
        if (is_base || (is_pointer(&*type) && !through_pointers)) {
            return found;
        }
        if (dwarf_tag(&*type) == DW_TAG_typedef) {
            found.names.push_back(name_of(&*type));
        }
        type = type_of(&*type);
    }
    return std::nullopt;
}

std::string name_of(Basic& basic) {
    return basic.names.empty() ? name_of(&basic.type) : basic.names.front();
}

}  // namespace shared_state
