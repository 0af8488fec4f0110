// What a name in a program's source means, by its debug information.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "debug_info/entries.hpp"
#include "debug_info/program_file.hpp"

namespace shared_state {

/// Where a name stands.
struct Place {
    Dwarf_Die entry;  ///< in the scope of the name: a variable, or the unit if no more is known
    std::string file;
    int line = 0;
};

Place place_of(Dwarf_Die variable);

struct Declaration {
    Dwarf_Die entry;                ///< of the last part of the expression
    std::optional<Dwarf_Die> type;  ///< of the whole expression
};

/// Whether an entry declares a variable or a member, not a type.
bool is_variable(Dwarf_Die* declaration);

class Declarations {
public:
    explicit Declarations(ProgramFile const& program);

    /// What an expression of names, members and elements means, by the rules of C: "mydata->states[].part". A type is
    /// an expression, too.
    std::optional<Declaration> meant_by(std::string const& expression, Place const& place);

private:
    /// `is_inside`: of a function or a type.
    void read(Dwarf_Die* scope, bool is_inside);
    std::optional<Dwarf_Die> first(std::string const& name, Place const& place);
    std::optional<Dwarf_Die> around(Dwarf_Die entry, std::string const& name);
    std::optional<Dwarf_Die> above(Place const& place, std::string const& name);
    std::optional<Dwarf_Die> anywhere(std::string const& name);
    std::optional<Dwarf_Die> member_of(std::optional<Dwarf_Die> type, std::string const& name);

    ScopeFinder scope_finder_;
    std::map<std::string, std::vector<Dwarf_Die>> variables_;  // by name, with parameters
    std::map<std::string, Dwarf_Die> outside_functions_;       // by name, with types
};

}  // namespace shared_state
