// gdb's remote protocol: packets, and what they ask of a robot. No sockets and no processor are here.
//
//     bytes of gdb ──► GdbReader ──► packets ──► GdbProtocol ──► GdbTarget
//                                                    └──► bytes for gdb
//
// Whatever bytes come, memory is bounded and nothing but the target changes. Packets that are not known get the empty
// answer, those that are malformed an error.
//
// Source: Debugging with GDB, appendix E, "GDB Remote Serial Protocol", and G.5.10 "RISC-V Features".
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "firmware/gdb_target.hpp"

namespace pogosim {

inline constexpr std::size_t kGdbPacketBytes = 16384;  // of a packet's contents, in both directions

/// "$contents#xx". Contents with '#', '$' or '}' have to be escaped before.
std::string gdb_packet(std::string_view contents);

/// Puts '}' before bytes that have a meaning in packets ('#', '$', '}', '*'), which are changed by 0x20.
std::string gdb_escaped(std::string_view bytes);

/// The bytes that were escaped. A '}' at the end, behind which there is nothing, is left out.
std::string gdb_unescaped(std::string_view contents);

/// Divides a stream of bytes into packets.
class GdbReader {
public:
    enum class Kind : std::uint8_t {
        none,          // the stream goes on
        packet,        // with the right checksum
        broken,        // with a wrong one, or too long: its contents are lost
        interrupt,     // Ctrl-C
        acknowledged,  // '+'
        repeat         // '-': the last packet got lost
    };
    struct Event {
        Kind kind = Kind::none;
        std::string contents{};  // of a packet, still escaped
    };

    /// Takes a byte, and says what it completes.
    Event take(char byte);

private:
    enum class State : std::uint8_t { between, contents, first_digit, second_digit };

    State state_ = State::between;
    std::string contents_;
    bool is_too_long_ = false;
    std::uint8_t sum_ = 0;
    char first_digit_ = 0;
};

/// The side of the robot in a connection with gdb.
class GdbProtocol {
public:
    explicit GdbProtocol(GdbTarget& target) : target_(target) {}

    /// Answers what a packet asks for. Returns bytes to be sent, which are empty for a robot that goes on: gdb waits
    /// for stop_reply() then.
    std::string answer(GdbReader::Event const& event);

    /// Bytes that say that the robot has stopped.
    std::string stop_reply();

    /// Bytes that say that the robot's program is over: by a signal, or at the end of the run.
    std::string exit_reply(std::optional<GdbSignal> signal);

private:
    std::string packet(std::string contents);
    std::optional<std::string> contents_of_answer(std::string_view packet);
    std::string query(std::string_view packet);
    std::string features(std::string_view range) const;
    std::string monitor(std::string_view hex) const;
    std::string all_registers() const;
    std::string write_all_registers(std::string_view hex);
    std::string read_register(std::string_view text) const;
    std::string write_register(std::string_view text);
    std::string read_memory(std::string_view text) const;
    std::string write_memory(std::string_view text, bool is_binary);
    std::string change_points(std::string_view packet);
    std::optional<std::string> resume(std::string_view packet);
    std::optional<std::string> resume_thread(std::string_view actions);
    std::string stop_text() const;

    GdbTarget& target_;
    bool acknowledges_ = true;
    bool ends_acknowledging_ = false;  // after the answer to QStartNoAckMode
    std::string last_;                 // packet that was sent, to be repeated
};

}  // namespace pogosim
