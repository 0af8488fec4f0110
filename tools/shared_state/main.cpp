// pogosim-shared-state: lists the variables that all simulated robots of a program share, though each real robot has
// its own. It looks at the program's debug information, so the program is compiled with -g.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "configured.hpp"
#include "debug_info.hpp"
#include "program_file.hpp"

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
    std::vector<std::string> ignored_folders = {"/usr/include", "/usr/lib", "/usr/lib64", "/usr/local/include",
                                                "/usr/local/lib"};
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

bool is_ignored(std::string const& file, Options const& options) {
    std::string const place = std::filesystem::weakly_canonical(file).string();
    return std::any_of(options.ignored_folders.begin(), options.ignored_folders.end(),
                       [&](std::string const& folder) { return place.starts_with(folder + "/"); });
}

// Shared unintentionally: writable, or set by the first robot that ran the line.
bool is_suspect(Object const& object, ProgramFile const& program) {
    auto const section = program.section_at(object.address);
    if (!section.writable || section.name.starts_with("pogo_shared")) {
        return false;
    }
    return !object.constant || program.has_guard(program.symbol_at(object.address));
}

std::vector<Object> find_shared_state(ProgramFile const& program, Options const& options) {
    DebugInfo const info = read_debug_info(program);
    auto const configured = configured_objects(info);
    std::vector<Object> found;
    for (auto const& object : info.objects) {
        if (is_suspect(object, program) && !configured.contains(object.address) && !is_ignored(object.file, options)) {
            found.push_back(object);
        }
    }

    // In source order; a variable in a header counts once, however many files include it.
    auto const key = [](Object const& object) {
        return std::tie(object.file, object.line, object.column, object.name);
    };
    std::sort(found.begin(), found.end(), [&](Object const& a, Object const& b) { return key(a) < key(b); });
    auto const last =
        std::unique(found.begin(), found.end(), [&](Object const& a, Object const& b) { return key(a) == key(b); });
    found.erase(last, found.end());
    return found;
}

// As compilers print it: relative to the working folder, if inside it.
std::string shown_file(std::string const& file) {
    auto const relative = std::filesystem::path(file).lexically_proximate(std::filesystem::current_path());
    return relative.empty() || relative.string().starts_with("..") ? file : relative.string();
}

void print(Object const& object, bool error) {
    std::string const place = shown_file(object.file) + ":" + std::to_string(object.line) +
                              (object.column > 0 ? ":" + std::to_string(object.column) : std::string());
    std::string const name = object.function.empty() ? object.qualifier + object.name : object.name;
    std::string const function = object.function.empty() ? "" : " in " + object.function + "()";
    char const* const what = object.constant
                                 ? "is set once, by the first robot to run this line, for all simulated robots"
                                 : "is shared by all simulated robots";
    std::fprintf(stderr, "%s: %s: '%s'%s (%llu byte%s) %s; on real robots each has its own [%s]\n", place.c_str(),
                 error ? "error" : "warning", name.c_str(), function.c_str(),
                 static_cast<unsigned long long>(object.bytes), object.bytes == 1 ? "" : "s", what,
                 error ? "-Werror=shared-state" : "-Wshared-state");
}

int check(Options const& options) {
    ProgramFile const program(options.program);
    if (program.is_for_sdk()) {
        return 0;
    }
    auto const found = find_shared_state(program, options);
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
