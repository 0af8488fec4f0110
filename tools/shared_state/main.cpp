// pogosim-shared-state: lists the variables that all simulated robots of a program share, though each real robot has
// its own. It looks at the program's debug information, so the program is compiled with -g.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "debug_info/debug_info.hpp"
#include "debug_info/program_file.hpp"
#include "debug_info/shared_variables.hpp"
#include "message_layout.hpp"

using namespace shared_state;

namespace {

constexpr char const* usage = R"(Usage: pogosim-shared-state [options] PROGRAM

Lists the modifiable variables that all simulated robots share: everything except USERDATA, variables read from the
configuration (init_from_configuration), variables marked POGO_SHARED, and those declared in system headers. None in
programs written for the robots' SDK alone (pogobot.h). Also lists members of messages that have another size on a
robot. PROGRAM is a linked executable with debug information (-g).

  --ignore FOLDER         ignore variables declared in files of this folder; may be repeated
  -Werror=shared-state    treat shared variables as errors
  -Wno-shared-state       disable the check
  -Werror=message-layout, -Wno-message-layout
                          the same for members of messages; -Werror stands for both
  -h, --help              print this help and exit

Exit codes: 0 nothing found, or warnings only; 1 found, with -Werror; 2 usage error, or unreadable program.
)";

// What is done about what a check finds: "shared-state".
struct Check {
    char const* name;
    bool errors = false;
    bool off = false;
};

struct Options {
    std::string program;
    Check shared_state{.name = "shared-state"};
    Check message_layout{.name = "message-layout"};
    bool help = false;
    std::vector<std::string> ignored_folders = system_folders();
};

// Whether the argument is about this check.
bool sets(Check& check, std::string const& argument) {
    std::string const name = check.name;
    if (argument == "-Werror=" + name || argument == "-Wno-error=" + name) {
        check.errors = argument == "-Werror=" + name;
        return true;
    }
    if (argument == "-W" + name || argument == "-Wno-" + name) {
        check.off = argument == "-Wno-" + name;
        return true;
    }
    return false;
}

Options read_options(std::vector<std::string> const& arguments) {
    Options options;
    for (std::size_t i = 0; i < arguments.size(); i++) {
        std::string const& argument = arguments[i];
        if (argument == "-Werror") {
            options.shared_state.errors = options.message_layout.errors = true;
        } else if (sets(options.shared_state, argument) || sets(options.message_layout, argument)) {
            continue;
        } else if (argument == "--ignore" && i + 1 < arguments.size()) {
            options.ignored_folders.push_back(std::filesystem::weakly_canonical(arguments[++i]).string());
        } else if (argument == "-h" || argument == "--help") {
            options.help = true;
        } else if (argument.starts_with("-") || !options.program.empty()) {
            throw ProgramError("unknown argument '" + argument + "'; see --help");
        } else {
            options.program = argument;
        }
    }
    if (options.program.empty() && !options.help) {
        throw ProgramError("no program specified; see --help");
    }
    return options;
}

// "main.c:31:21: warning", as compilers say it.
std::string beginning(std::string const& file, int line, int column, Check const& check) {
    return shown_file(file) + ":" + std::to_string(line) + (column > 0 ? ":" + std::to_string(column) : "") +
           (check.errors ? ": error" : ": warning");
}

std::string end(Check const& check) {
    return std::string(check.errors ? "[-Werror=" : "[-W") + check.name + "]";
}

void print(Object const& object, Check const& check) {
    char const* const what = object.constant
                                 ? "is set once, by the first robot to run this line, for all simulated robots"
                                 : "is shared by all simulated robots";
    std::fprintf(stderr, "%s: %s (%llu byte%s) %s; real robots cannot share it %s\n",
                 beginning(object.file, object.line, object.column, check).c_str(), shown_name(object).c_str(),
                 static_cast<unsigned long long>(object.bytes), object.bytes == 1 ? "" : "s", what, end(check).c_str());
}

// What is odd about a member: "is an address, which means nothing to another robot".
std::string oddity(OddMember const& member) {
    std::string const bytes = std::to_string(member.bytes);
    std::string const is_type = (member.is_inside ? "contains '" : "is of type '") + member.type + "'";
    switch (member.oddity) {
        case OddMember::Oddity::other_size:
            return is_type + " (" + bytes +
                   " bytes), which has another size on a real robot: take uint32_t or another type of fixed size";
        case OddMember::Oddity::other_format:
            return is_type + ", whose bytes mean another number on a real robot: take float or double";
        case OddMember::Oddity::address:
            return (member.is_inside ? "contains" : "is") +
                   std::string(" an address, which means nothing to another robot");
        case OddMember::Oddity::virtual_functions:
            return "has virtual functions, so it contains an address, which means nothing to another robot";
        case OddMember::Oddity::size_of_address:
            break;
    }
    return "";
}

void print(OddMember const& member, Check const& check) {
    std::string text =
        "'" + member.name + "' " +
        (member.message.empty() ? "is sent as a message and " : "in the message '" + member.message + "' ") +
        oddity(member);
    if (member.oddity == OddMember::Oddity::size_of_address) {
        text = "'sizeof(" + member.name +
               ")' is the size of an address, 8 bytes here and 4 on a real robot: take the size " +
               "of what it points to";
    }
    std::fprintf(stderr, "%s: %s %s\n", beginning(member.file, member.line, member.column, check).c_str(), text.c_str(),
                 end(check).c_str());
}

// Whether what it finds is an error.
bool check_shared_state(ProgramFile const& program, Options const& options) {
    if (options.shared_state.off || program.is_for_sdk()) {
        return false;
    }
    auto const found = shared_variables(read_debug_info(program), program, options.ignored_folders);
    for (auto const& object : found) {
        print(object, options.shared_state);
    }
    if (!found.empty()) {
        std::fprintf(
            stderr,
            "Move it to USERDATA, read it in global_setup with init_from_configuration(), or mark it POGO_SHARED if "
            "sharing is intended. With 'robot_memory: own' in its configuration, each robot has its own.\n");
    }
    return options.shared_state.errors && !found.empty();
}

bool check_message_layout(ProgramFile const& program, Options const& options) {
    if (options.message_layout.off) {
        return false;
    }
    auto const found = odd_members_of_messages(program, options.ignored_folders);
    for (auto const& member : found) {
        print(member, options.message_layout);
    }
    return options.message_layout.errors && !found.empty();
}

int check(Options const& options) {
    if (options.shared_state.off && options.message_layout.off) {
        return 0;
    }
    ProgramFile const program(options.program);
    bool const shares = check_shared_state(program, options);
    bool const differs = check_message_layout(program, options);
    return shares || differs ? 1 : 0;
}

}  // namespace

int main(int count, char** arguments) {
    try {
        Options const options = read_options({arguments + 1, arguments + count});
        if (options.help) {
            std::fputs(usage, stdout);
            return 0;
        }
        return check(options);
    } catch (std::exception const& error) {
        std::fprintf(stderr, "pogosim-shared-state: %s\n", error.what());
        return 2;
    }
}
