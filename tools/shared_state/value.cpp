#include "value.hpp"

#include <dwarf.h>

namespace shared_state {

namespace {

std::optional<Dwarf_Die> named_member(Dwarf_Die structure, std::string const& name) {
    std::optional<Dwarf_Die> found;
    for_each_child(&structure, [&](Dwarf_Die child) {
        int const tag = dwarf_tag(&child);
        if (found || (tag != DW_TAG_member && tag != DW_TAG_variable && tag != DW_TAG_inheritance)) {
            return;
        }
        if (name_of(&child) == name) {
            found = child;
        } else if (tag == DW_TAG_inheritance || name_of(&child).empty()) {
            auto inner = basic_type(type_of(&child), /*through_pointers=*/false);
            found = inner && is_structure(&inner->type) ? named_member(inner->type, name) : std::nullopt;
        }
    });
    return found;
}

}  // namespace

Value value_of_type(std::optional<Dwarf_Die> type, std::optional<Dwarf_Die> declaration) {
    Value value;
    value.declaration = declaration;
    std::vector<std::string> names;
    for (; type; type = type_of(&*type)) {
        int const tag = dwarf_tag(&*type);
        if (tag == DW_TAG_base_type || is_structure(&*type)) {
            value.base = Basic{*type, names};
            break;
        }
        if (tag == DW_TAG_typedef) {
            names.push_back(name_of(&*type));
        } else if (tag == DW_TAG_pointer_type) {
            value.layers.push_back({.is_pointer = true, .type = type});
            names.clear();
        } else if (tag == DW_TAG_array_type) {
            for_each_child(&*type, [&](Dwarf_Die child) {
                if (dwarf_tag(&child) == DW_TAG_subrange_type) {
                    value.layers.push_back({.is_pointer = false, .type = type});
                }
            });
            names.clear();
        }
    }
    return value;
}

std::optional<Value> dereferenced(Value value) {
    if (value.layers.empty() || value.as_bytes || value.is_size) {
        return std::nullopt;
    }
    value.layers.erase(value.layers.begin());
    return value;
}

std::optional<Value> address_of(Value value) {
    if (value.as_bytes || value.is_size) {
        return std::nullopt;
    }
    value.layers.insert(value.layers.begin(), Value::Layer{.is_pointer = true, .type = std::nullopt});
    return value;
}

std::optional<Value> member_of(Value value, std::string const& name) {
    if (!value.layers.empty() || !value.base || !is_structure(&value.base->type) || value.is_size) {
        return std::nullopt;
    }
    auto found = named_member(value.base->type, name);
    return found ? std::optional(value_of_type(type_of(&*found), found)) : std::nullopt;
}

std::optional<Value> moved(Value value) {
    bool const is_known = !value.layers.empty() && !value.as_bytes && !value.is_size;
    return is_known ? std::optional(value) : std::nullopt;
}

Values together(Values values, Values const& others) {
    values.insert(values.end(), others.begin(), others.end());
    return values;
}

}  // namespace shared_state
