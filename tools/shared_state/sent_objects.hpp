// Objects whose address is given to the functions that send messages.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "debug_info/program_file.hpp"
#include "types.hpp"

namespace shared_state {

struct SentObject {
    std::string name;  ///< as in the call: "k", "mydata->state"
    Dwarf_Die declaration;
    Basic type;  ///< of an array, that of its elements
};

/// Whether this variable is a note that a call of a sending function left behind: POGO_NOTE_SENT in infrared.h.
bool is_note_of_sending(Dwarf_Die* variable);

/// The objects that the arguments in the note mean, by the rules of C for names.
std::vector<SentObject> sent_objects(Dwarf_Die* note, ProgramFile const& program);

}  // namespace shared_state
