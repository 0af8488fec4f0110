// The value of an expression, as far as it tells which object a pointer points to; and what operators make of it.
#pragma once

#include <elfutils/libdw.h>

#include <optional>
#include <string>
#include <vector>

#include "types.hpp"

namespace shared_state {

/// The value of an expression: its type as layers around a basic type, and where it was declared.
struct Value {
    struct Layer {
        bool is_pointer = false;        ///< or an array
        std::optional<Dwarf_Die> type;  ///< none for `&x`
    };
    std::vector<Layer> layers;  ///< the outermost first: `*` and `[i]` take it off
    std::optional<Basic> base;  ///< none: void, or not known
    std::optional<Dwarf_Die> declaration;
    bool as_bytes = false;  ///< a pointer that was cast to uint8_t* or the like; the layers are those before
    bool is_size = false;   ///< `sizeof` of such a value
};

/// Several where a condition chooses; empty: not known.
using Values = std::vector<Value>;

Value value_of_type(std::optional<Dwarf_Die> type, std::optional<Dwarf_Die> declaration);

// What operators make of a value: none if that is not known.

/// `*value`, `value[i]`
std::optional<Value> dereferenced(Value value);

/// `&value`
std::optional<Value> address_of(Value value);

/// `value.name`, also of unnamed members and of base classes.
std::optional<Value> member_of(Value value, std::string const& name);

/// `value + number`. What bytes at an offset belong to is not known.
std::optional<Value> moved(Value value);

Values together(Values values, Values const& others);

template <class Change>
Values each(Values const& values, Change const& change) {
    Values changed;
    for (Value const& value : values) {
        if (std::optional<Value> const one = change(value)) {
            changed.push_back(*one);
        }
    }
    return changed;
}

}  // namespace shared_state
