#include "types.hpp"

#include <dwarf.h>

namespace shared_state {

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
