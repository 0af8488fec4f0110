// pogolib/console.h: printf of the robots.
#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "base/log.hpp"
#include "process/crash_handler.hpp"
#include "process/process.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"
#include "robot/waiting.hpp"

using pogosim::context;

namespace {

constexpr std::size_t kShortText = 512;
constexpr std::size_t kLongestLine = 65536;  // longer lines are split, to limit memory use

/// A format in which a single `l` before an integer conversion is gone: `long` has 32 bits on the robot, and programs
/// print uint32_t with %lu.
std::string with_robot_longs(std::string_view format) {
    std::string result;
    result.reserve(format.size());
    for (std::size_t i = 0; i < format.size(); ++i) {
        result += format[i];
        if (format[i] != '%') {
            continue;
        }
        // Flags, width and precision, or the number of an argument, are between '%' and the length.
        std::size_t const length = std::min(format.find_first_not_of("-+ #0123456789.*'$", i + 1), format.size());
        result += format.substr(i + 1, length - i - 1);
        bool const single_l =
            length + 1 < format.size() && format[length] == 'l' && std::strchr("diouxX", format[length + 1]) != nullptr;
        i = single_l ? length : length - 1;
        // The conversion, or a second '%', is copied here so that "%%" does not start another one.
        if (i + 1 < format.size()) {
            result += format[++i];
        }
    }
    return result;
}

void print_line(std::string_view line) {
    if (context.is_system) {
        pogosim::robot_log().info("[SYSTEM] [PRINTF] {}", line);
    } else if (context.outbox != nullptr) {
        context.outbox->said.push_back({.robot = context.robot, .kind = {}, .text = std::string(line)});
    } else {
        context.services->print_line(*context.world, context.robot, line);
    }
}

/// Logs the lines in `text` and leaves the rest there; up to `searched` there is no line end.
void print_complete_lines(std::string& text, std::size_t searched) {
    std::size_t start = 0;
    for (std::size_t end = text.find('\n', searched); end != std::string::npos; end = text.find('\n', start)) {
        print_line(std::string_view(text).substr(start, end - start));
        start = end + 1;
    }
    text.erase(0, start);
    if (text.size() >= kLongestLine) {
        print_line(text);
        text.clear();
    }
}

/// False before main(), after the run, in a thread and in a child process: there the program prints, not a robot.
bool is_robot_printing() {
    return context.printed != nullptr && !pogosim::is_forked_child();
}

void print(std::string_view text) {
    if (!is_robot_printing()) {
        std::fwrite(text.data(), 1, text.size(), stdout);
        return;
    }
    pogosim::without_exceptions([&] {
        std::string& printed = *context.printed;
        std::size_t const before = printed.size();
        printed += text;
        print_complete_lines(printed, before);
    });
}

/// Some programs for the robots alone print for ever in main(); in a step that is a mistake.
void note_output() {
    if (is_robot_printing() && context.phase == pogosim::Phase::main) {
        pogosim::note_call();
    }
}

}  // namespace

int pogosim_vprintf(char const* format, va_list arguments) {
    if (is_robot_printing()) {
        pogosim::require_argument(format, "vprintf", "the format");
    } else if (format == nullptr) {
        return -1;
    }
    int size = -1;
    pogosim::without_exceptions([&] {
        std::string const host_format = with_robot_longs(format);
        va_list again;
        va_copy(again, arguments);
        char text[kShortText];
        size = std::vsnprintf(text, sizeof(text), host_format.c_str(), arguments);
        if (size >= static_cast<int>(sizeof(text))) {
            std::vector<char> long_text(static_cast<std::size_t>(size) + 1);
            std::vsnprintf(long_text.data(), long_text.size(), host_format.c_str(), again);
            print({long_text.data(), static_cast<std::size_t>(size)});
        } else if (size > 0) {
            print({text, static_cast<std::size_t>(size)});
        }
        va_end(again);
    });
    note_output();
    return size;
}

int pogosim_printf(char const* format, ...) {
    if (is_robot_printing()) {
        pogosim::require_argument(format, "printf", "the format");
    }
    va_list arguments;
    va_start(arguments, format);
    int const size = pogosim_vprintf(format, arguments);
    va_end(arguments);
    return size;
}

int pogosim_putchar(int character) {
    char const text = static_cast<char>(character);
    print({&text, 1});
    note_output();
    return static_cast<unsigned char>(character);
}

int pogosim_puts(char const* text) {
    if (is_robot_printing()) {
        pogosim::require_argument(text, "puts", "the text");
    } else if (text == nullptr) {
        return EOF;
    }
    print(text);
    print("\n");
    note_output();
    return 0;
}
