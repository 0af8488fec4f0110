#include "types.hpp"

#include <dwarf.h>

namespace shared_state {

bool is_structure(Dwarf_Die* type) {
    int const tag = dwarf_tag(type);
    return tag == DW_TAG_structure_type || tag == DW_TAG_class_type || tag == DW_TAG_union_type;
}

bool is_type(Dwarf_Die* declaration) {
    return dwarf_tag(declaration) == DW_TAG_typedef || is_structure(declaration);
}

bool is_pointer(Dwarf_Die* type) {
    int const tag = dwarf_tag(type);
    return tag == DW_TAG_pointer_type || tag == DW_TAG_reference_type || tag == DW_TAG_rvalue_reference_type;
}

std::optional<Dwarf_Die> unnamed(std::optional<Dwarf_Die> type) {
    while (type) {
        switch (dwarf_tag(&*type)) {
            case DW_TAG_typedef:
            case DW_TAG_const_type:
            case DW_TAG_volatile_type:
            case DW_TAG_reference_type:
            case DW_TAG_rvalue_reference_type:
                type = type_of(&*type);
                break;
            default:
                return type;
        }
    }
    return type;
}

bool is_array(Dwarf_Die* type) {
    return dwarf_tag(type) == DW_TAG_array_type;
}

std::optional<Dwarf_Die> element(std::optional<Dwarf_Die> type) {
    auto bare = unnamed(type);
    if (!bare || (!is_array(&*bare) && !is_pointer(&*bare))) {
        return std::nullopt;
    }
    int dimensions = 0;
    for_each_child(&*bare, [&](Dwarf_Die child) { dimensions += dwarf_tag(&child) == DW_TAG_subrange_type; });
    return dimensions > 1 ? bare : type_of(&*bare);
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
