// The variables of a program by name and type, from its debug information (DWARF, versions 2 to 5).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "process/program_image.hpp"

namespace pogosim {

struct VariableType;
using VariableTypePointer = std::shared_ptr<VariableType const>;

struct VariableType {
    enum class Kind {
        boolean,
        signed_number,
        unsigned_number,
        text,
        floating,
        enumeration,
        pointer,
        structure,
        array,
        unknown
    };

    struct Member {
        std::string name;
        std::size_t offset = 0;    // bytes from the beginning
        unsigned first_bit = 0;    // of a bit field, from the lowest bit at `offset` on
        unsigned bits = 0;         // 0: it is none
        VariableTypePointer type;  // never null
    };

    Kind kind = Kind::unknown;  // text: a character, as in strings
    std::size_t bytes = 0;
    std::vector<Member> members{};  // of a structure or union, in the order of the source
    std::vector<std::pair<std::int64_t, std::string>> constants{};  // of an enumeration
    VariableTypePointer element{};  // of an array; of an enumeration, the number that it is, null if that is not known
    std::size_t count = 0;          // of elements
};

struct ProgramVariables {
    struct Variable {
        std::string name;            // "count", and where another one has this name "step: count" or "main.c: count"
        std::uintptr_t address = 0;  // from where the program is loaded
        VariableTypePointer type;
    };

    std::string why_unknown{};        // for the user; empty: they are known
    VariableTypePointer user_data{};  // USERDATA; null: the program has none
    std::vector<Variable>
        own{};  // those of which each robot may have its own (robot_memory: own), by place in the source
};

/// Reads the variables from the file of a program; leaves out those whose debug information is not understood.
ProgramVariables variables_of(ProgramImage const& image);

/// The variables of a file, also of one for another processor, at addresses that are wanted.
ProgramVariables variables_in_file(std::string const& file, std::function<bool(std::uintptr_t address)> is_wanted);

}  // namespace pogosim
