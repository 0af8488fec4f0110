// Says what the simulator reads from a program's file of macOS:
//
//   mach_o_reader FILE arm64|x86_64             a line for each variable, piece of memory, name that is used, ...
//   mach_o_reader FILE arm64|x86_64 CHANGES     reads it cut off and changed so many times: says how many are refused
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "process/mach_o_symbols.hpp"

namespace {

using namespace pogosim;

void say(MachOFile const& file) {
    fmt::print("problem {}\n", problem_of_mach_o(file));
    fmt::print("build {}\n", file.build);
    for (std::string_view const library : file.libraries) {
        fmt::print("library {}\n", library);
    }
    ProgramSymbols const symbols = mach_o_symbols(file);
    fmt::print("known {:d} static {:d} threads {} format {}\n", symbols.are_known, symbols.has_static,
               symbols.bytes_of_threads, symbols.allocating_format);
    for (ProgramSymbols::Variable const& variable : symbols.variables) {
        bool const is_of_robots = std::ranges::any_of(symbols.memory, [&](ProgramSymbols::Piece const& piece) {
            return variable.address >= piece.begin && variable.address < piece.end;
        });
        fmt::print("variable {} {} {}\n", variable.name, variable.bytes,
                   variable.is_of_thread ? "thread" : (is_of_robots ? "robots" : "shared"));
    }
    for (std::string const& name : symbols.imports) {
        fmt::print("import {}\n", name);
    }
    for (std::string const& name : mach_o_variables_of_all_copies(file)) {
        fmt::print("copies {}\n", name);
    }
    for (std::string const& text : mach_o_texts(file, "pogosim_configured")) {
        fmt::print("text {}\n", text);
    }
    for (ProgramFunction const& function : mach_o_functions(file)) {
        constexpr std::uintptr_t inside = 1;
        fmt::print("function {} {:d}\n", function.name(),
                   mach_o_function_at(file, function.address + inside) == function.symbol);
    }
}

/// Reads all, as say() does. Returns whether the file would be refused.
bool is_refused(std::vector<char> const& bytes, MachOProcessor processor) {
    MachOFile const file = mach_o_file(bytes, processor);
    mach_o_symbols(file);
    mach_o_variables_of_all_copies(file);
    mach_o_texts(file, "pogosim_configured");
    mach_o_function_at(file, bytes.size() / 2);
    return !problem_of_mach_o(file).empty();
}

void say_of_changes(std::vector<char> const& bytes, MachOProcessor processor, int changes) {
    std::minstd_rand random;
    int cut_off = 0;
    int damaged = 0;
    constexpr std::size_t head = 4096;  // where most of what is read lies
    for (int i = 0; i < changes; ++i) {
        std::size_t const length = random() % bytes.size();
        cut_off += is_refused({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}, processor) ? 1 : 0;
        std::vector<char> changed = bytes;
        for (int byte = 0; byte < 4; ++byte) {
            std::size_t const range = byte % 2 == 0 ? std::min(head, bytes.size()) : bytes.size();
            changed[random() % range] = static_cast<char>(random());
        }
        damaged += is_refused(changed, processor) ? 1 : 0;
    }
    fmt::print("cut off {} damaged {}\n", cut_off, damaged);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        return EXIT_FAILURE;
    }
    std::ifstream file(argv[1], std::ios::binary);
    std::vector<char> const bytes{std::istreambuf_iterator<char>(file), {}};
    auto const processor = std::string_view(argv[2]) == "arm64" ? MachOProcessor::arm64 : MachOProcessor::x86_64;
    if (argc > 3) {
        say_of_changes(bytes, processor, std::atoi(argv[3]));
    } else {
        say(mach_o_file(bytes, processor));
    }
}
