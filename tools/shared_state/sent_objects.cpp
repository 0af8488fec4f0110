#include "sent_objects.hpp"

#include <algorithm>

#include "expression.hpp"

namespace shared_state {

namespace {

bool is_one_byte(Basic& basic) {
    return !is_structure(&basic.type) && dwarf_bytesize(&basic.type) <= 1;
}

// The type of the elements, if it is an array.
std::optional<Basic> type_of_object(Value const& value) {
    auto const layer = std::find_if(value.layers.begin(), value.layers.end(), [](auto& one) { return one.is_pointer; });
    if (layer == value.layers.end()) {
        return value.base;
    }
    return layer->type ? std::optional(Basic{*layer->type, {}}) : std::nullopt;
}

// `is_buffer`: whether bytes are no more than that.
std::optional<SentObject> object_of(Value const& value, bool is_buffer) {
    auto basic = type_of_object(value);
    if (!basic || (!value.declaration && !is_structure(&basic->type))) {
        return std::nullopt;
    }
    Dwarf_Die declaration = value.declaration ? *value.declaration : basic->type;
    return SentObject{.name = name_of(&declaration),
                      .declaration = declaration,
                      .type = *basic,
                      .is_buffer = is_buffer && is_one_byte(*basic)};
}

std::optional<SentObject> object_pointed_to(Value value) {
    if (value.layers.empty()) {
        return std::nullopt;  // an offset
    }
    bool const is_declared = value.layers[0].type.has_value();
    value.layers.erase(value.layers.begin());
    return object_of(value, is_declared);
}

std::optional<SentObject> object_of_size(Value const& value) {
    auto object = object_of(value, /*is_buffer=*/!value.layers.empty());
    bool const is_address = !value.layers.empty() && value.layers[0].is_pointer;
    if (object && is_address) {
        object->is_size_of_address = true;
        object->is_buffer = false;
    }
    return object;
}

// For `&k, sizeof k`, where k is a pointer.
bool is_sent_itself(SentObject& address, std::vector<SentObject>& found) {
    return std::any_of(found.begin(), found.end(), [&](SentObject& one) {
        return is_pointer(&one.type.type) && dwarf_dieoffset(&one.declaration) == dwarf_dieoffset(&address.declaration);
    });
}

}  // namespace

std::vector<SentObject> sent_objects(std::string const& arguments, Place const& place, Declarations& declarations) {
    auto const find_name = [&](std::string const& name) -> std::optional<Dwarf_Die> {
        auto const found = declarations.meant_by(name, place);
        return found ? std::optional(found->entry) : std::nullopt;
    };
    auto const expressions = read_arguments(arguments, find_name);
    std::vector<SentObject> found;
    for (std::size_t i = 0; i < std::max<std::size_t>(expressions.size() - 1, 1); i++) {
        for (Value const& value : expressions[i].values) {
            if (auto const object = object_pointed_to(value); object && !value.is_size) {
                found.push_back(*object);
            }
        }
    }
    // What has the size of one object is that object, not the larger one in which it may be.
    Expression const& size = expressions.back();
    std::vector<SentObject> sizes;
    for (Value const& value : size.sizes) {
        auto object = object_of_size(value);
        if (object && !(object->is_size_of_address && is_sent_itself(*object, found))) {
            sizes.push_back(*object);
        }
    }
    bool const is_of_one_size =
        sizes.size() == 1 && !sizes[0].is_size_of_address && !size.values.empty() && size.values[0].is_size;
    if (is_of_one_size) {
        return sizes;
    }
    found.insert(found.end(), sizes.begin(), sizes.end());
    return found;
}

}  // namespace shared_state
