// The variables of a program's own files, from its debug information (DWARF, versions 2 to 5).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "debug_info/program_file.hpp"

namespace shared_state {

/// Identifies a function, or a source file with all it includes; 0 is none.
using Scope = uint64_t;

/// A variable that exists once, for the whole run: a global, a static one, a static member.
struct Object {
    std::string name;       ///< as in its declaration: "gain"
    std::string qualifier;  ///< namespaces and classes in front of it: "limits::", or empty
    std::string function;   ///< the one it is local to, or empty
    Scope function_scope = 0;
    Scope unit = 0;  ///< the source file that was compiled
    bool external = false;

    std::string file;
    int line = 0;
    int column = 0;
    uint64_t address = 0;
    uint64_t bytes = 0;
    bool constant = false;  ///< its type is const, or a reference
    bool pointer = false;
    bool structure = false;  ///< or a class, or an array of them
};

/// What a call of init_from_configuration(variable) and the like left behind.
struct Note {
    std::string text;       ///< of the first argument: "gain", "&limits.low", "table[3]"
    std::string qualifier;  ///< namespaces and classes around the function
    Scope function_scope = 0;
    Scope unit = 0;
};

struct DebugInfo {
    std::vector<Object> objects;                             ///< by address
    std::vector<Note> notes;                                 ///< in no order
    std::map<Scope, std::set<std::string>> local_to_a_call;  ///< parameters and automatic variables of functions
};

/// The path of a file that was compiled with a unit.
std::string path_in(Dwarf_Die* unit, char const* file);

/// The path of the file in which something is declared. Tables of files begin with the compiled file, which libdw does
/// not count as one.
std::string file_of(Dwarf_Die* entry);

/// Address of a variable that has one for the whole run; none for an automatic or a thread-local one.
std::optional<uint64_t> address_of(Dwarf_Die* variable);

/// Reads all compiled files, including objects of library headers.
DebugInfo read_debug_info(ProgramFile const& program);

}  // namespace shared_state
