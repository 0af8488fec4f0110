// Members of messages that differ on a real robot, whose addresses and `long` have 32 bits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "debug_info/program_file.hpp"

namespace shared_state {

struct OddMember {
    enum class Oddity { other_size, other_format, address, virtual_functions, size_of_address };

    std::string message{};  ///< "heartbeat_t"; empty: a whole variable is sent
    std::string name{};     ///< of the member, the variable, or the class with virtual functions
    Oddity oddity = Oddity::other_size;
    std::string type{};      ///< "size_t"
    bool is_inside = false;  ///< of a class of a library: std::array<long, 2>
    uint64_t bytes = 0;
    std::string file{};
    int line = 0;
    int column = 0;
};

/// In source order. Messages are the objects that calls of sending functions name; what the source copies to or from
/// the payload of a message, or takes it for; and, if no call names more than bytes, structures whose name contains
/// "message", "msg", "packet" or "payload" and which are no part of USERDATA. Files in the ignored folders are not
/// looked at.
std::vector<OddMember> odd_members_of_messages(ProgramFile const& program,
                                               std::vector<std::string> const& ignored_folders);

}  // namespace shared_state
