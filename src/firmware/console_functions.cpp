// The serial port of a robot, below printf() and the like, which the firmware brings along.
#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/firmware_call.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kLongestLine = 65536;  // longer lines are split, to limit memory use

void say_line(FirmwareCall const& call) {
    call.out.said.push_back({.robot = call.robot, .text = call.self.printed});
    call.self.printed.clear();
}

/// A program that ends its lines with \r\n, as terminals want it, prints the same lines.
CallOutcome write_character(FirmwareCall& call) {
    char const character = static_cast<char>(call.byte(0));
    if (character == '\n') {
        say_line(call);
    } else if (character != '\r') {
        call.self.printed += character;
        if (call.self.printed.size() >= kLongestLine) {
            say_line(call);
        }
    }
    return CallOutcome::returns;
}

CallOutcome has_no_input(FirmwareCall& call) {
    call.give(0);
    return CallOutcome::returns;
}

/// Nothing is ever typed.
CallOutcome wait_for_input(FirmwareCall& call) {
    call.note_slip({"the terminal", "a key to be typed", "the robot waits for ever"}, "not simulated");
    return CallOutcome::ends;
}

}  // namespace

std::span<LibraryFunction const> console_functions() {
    static std::array const functions{
        LibraryFunction{"uart_write", write_character, &CallTimes::print_byte_us, Noted::at_line_end},
        LibraryFunction{"uart_init", do_nothing},
        LibraryFunction{"uart_sync", do_nothing},
        LibraryFunction{"uart_isr", do_nothing},
        LibraryFunction{"uart_read_nonempty", has_no_input},
        LibraryFunction{"readchar_nonblock", has_no_input},
        LibraryFunction{"uart_read", wait_for_input},
        LibraryFunction{"readchar", wait_for_input},
        LibraryFunction{"base_getchar", wait_for_input},
    };
    return functions;
}

}  // namespace pogosim
