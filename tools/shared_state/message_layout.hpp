// Members of messages that have another size on a real robot, whose addresses and `long` have 32 bits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "debug_info/program_file.hpp"

namespace shared_state {

struct OddMember {
    std::string message;  // "heartbeat_t"; empty: a whole variable is sent
    std::string name;
    std::string type{};  // "size_t"; empty: a pointer
    uint64_t bytes = 0;
    std::string file;
    int line = 0;
    int column = 0;
};

/// In source order. Messages are what a call of a sending function names; and, as debug information does not tell what
/// else is sent, structures whose name contains "message", "msg", "packet" or "payload", and those of which a function
/// that takes a message_t* has a variable or a pointer, unless USERDATA contains them (clang does not tell the type of
/// `mydata`: there, only names count).
std::vector<OddMember> odd_members_of_messages(ProgramFile const& program);

}  // namespace shared_state
