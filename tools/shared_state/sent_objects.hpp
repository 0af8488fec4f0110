// Objects whose bytes are sent, or received: those that the arguments of a call name.
#pragma once

#include <string>
#include <vector>

#include "declarations.hpp"
#include "types.hpp"

namespace shared_state {

struct SentObject {
    std::string name;  ///< as in the call: "k", "mydata->state"
    Dwarf_Die declaration;
    Basic type{};                     ///< of an array, that of its elements
    bool is_buffer = false;           ///< bytes, whose meaning the call does not tell
    bool is_size_of_address = false;  ///< the number of bytes is sizeof(pointer)
};

/// What arguments such as "(uint8_t*)&k, sizeof k" mean at a place, by the rules of C for names. The last one is the
/// number of bytes.
std::vector<SentObject> sent_objects(std::string const& arguments, Place const& place, Declarations& declarations);

}  // namespace shared_state
