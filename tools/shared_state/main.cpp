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

using namespace shared_state;

namespace {

constexpr char const* usage = R"(Usage: pogosim-shared-state [options] PROGRAM

Lists the modifiable variables that all simulated robots share: everything except USERDATA, variables read from the
configuration (init_from_configuration), variables marked POGO_SHARED, and those declared in system headers. None in
programs written for the robots' SDK alone (pogobot.h). PROGRAM is a linked executable with debug information (-g).

  --ignore FOLDER         ignore variables declared in files of this folder; may be repeated
  -Werror=shared-state    treat shared variables as errors
  -Wno-shared-state       disable the check
  -h, --help              print this help and exit

Exit codes: 0 nothing found, or warnings only; 1 found, with -Werror=shared-state; 2 usage error, or unreadable program.
)";

struct Options {
    std::string program;
    bool errors = false;
    bool off = false;
    bool help = false;
    std::vector<std::string> ignored_folders = system_folders();
};

Options read_options(std::vector<std::string> const& arguments) {
    Options options;
    for (std::size_t i = 0; i < arguments.size(); i++) {
        std::string const& argument = arguments[i];
        if (argument == "-Werror=shared-state" || argument == "-Werror") {
            options.errors = true;
        } else if (argument == "-Wno-error=shared-state") {
            options.errors = false;
        } else if (argument == "-Wshared-state" || argument == "-Wno-shared-state") {
            options.off = argument == "-Wno-shared-state";
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

void print(Object const& object, bool error) {
    std::string const place = shown_file(object.file) + ":" + std::to_string(object.line) +
                              (object.column > 0 ? ":" + std::to_string(object.column) : std::string());
    char const* const what = object.constant
                                 ? "is set once, by the first robot to run this line, for all simulated robots"
                                 : "is shared by all simulated robots";
    std::fprintf(stderr, "%s: %s: %s (%llu byte%s) %s; on real robots each has its own [%s]\n", place.c_str(),
                 error ? "error" : "warning", shown_name(object).c_str(), static_cast<unsigned long long>(object.bytes),
                 object.bytes == 1 ? "" : "s", what, error ? "-Werror=shared-state" : "-Wshared-state");
}

int check(Options const& options) {
    ProgramFile const program(options.program);
    if (program.is_for_sdk()) {
        return 0;
    }
    auto const found = shared_variables(read_debug_info(program), program, options.ignored_folders);
    for (auto const& object : found) {
        print(object, options.errors);
    }
    if (!found.empty()) {
        std::fprintf(
            stderr,
            "Move it to USERDATA, read it in global_setup with init_from_configuration(), or mark it POGO_SHARED if "
            "sharing is intended. With 'robot_memory: own' in its configuration, each robot has its own.\n");
    }
    return options.errors && !found.empty() ? 1 : 0;
}

}  // namespace

int main(int count, char** arguments) {
    try {
        Options const options = read_options({arguments + 1, arguments + count});
        if (options.help) {
            std::fputs(usage, stdout);
            return 0;
        }
        return options.off ? 0 : check(options);
    } catch (std::exception const& error) {
        std::fprintf(stderr, "pogosim-shared-state: %s\n", error.what());
        return 2;
    }
}
