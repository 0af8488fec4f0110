#include "declarations.hpp"

#include <dwarf.h>

#include <functional>
#include <regex>

#include "debug_info/debug_info.hpp"
#include "types.hpp"

namespace shared_state {

namespace {

std::optional<Dwarf_Die> declared_in(Dwarf_Die* scope, std::string const& name) {
    std::optional<Dwarf_Die> found;
    for_each_child(scope, [&](Dwarf_Die child) {
        int const tag = dwarf_tag(&child);
        bool const is_wanted = tag == DW_TAG_variable || tag == DW_TAG_formal_parameter || tag == DW_TAG_member ||
                               tag == DW_TAG_typedef || is_structure(&child);
        if (is_wanted && name_of(&child) == name && (!found || dwarf_tag(&*found) != DW_TAG_variable)) {
            found = child;
        }
    });
    return found;
}

// The last variable of this name above a place in its file: clang puts a note into its function, not into the block,
// and optimised code may not tell the function either.
std::optional<Dwarf_Die> declared_above(Place place, std::string const& name) {
    Dwarf_Die unit;
    if (!dwarf_diecu(&place.entry, &unit, nullptr, nullptr)) {
        return std::nullopt;
    }
    std::optional<Dwarf_Die> found;
    int found_line = 0;
    std::function<void(Dwarf_Die)> const look_at = [&](Dwarf_Die entry) {
        int const tag = dwarf_tag(&entry);
        int line = 0;
        if ((tag == DW_TAG_variable || tag == DW_TAG_formal_parameter) && name_of(&entry) == name &&
            dwarf_decl_line(&entry, &line) == 0 && line <= place.line && line > found_line &&
            file_of(&entry) == place.file) {
            found = entry;
            found_line = line;
        }
        for_each_child(&entry, look_at);
    };
    look_at(unit);
    return found;
}

// clang does not tell what is declared in one file and defined in another.
std::optional<Dwarf_Die> declared_anywhere(ProgramFile const& program, std::string const& name) {
    std::optional<Dwarf_Die> found;
    std::function<void(Dwarf_Die)> const look_in = [&](Dwarf_Die scope) {
        if (found) {
            return;
        }
        found = declared_in(&scope, name);
        for_each_child(&scope, [&](Dwarf_Die child) {
            if (dwarf_tag(&child) == DW_TAG_namespace) {
                look_in(child);
            }
        });
    };
    for_each_unit(program.debug_info(), look_in);
    return found;
}

std::optional<Dwarf_Die> member_of(std::optional<Dwarf_Die> type, std::string const& name) {
    auto basic = basic_type(type, /*through_pointers=*/true);
    if (!basic || !is_structure(&basic->type)) {
        return std::nullopt;
    }
    auto found = declared_in(&basic->type, name);
    for_each_child(&basic->type, [&](Dwarf_Die child) {
        bool const is_unnamed = dwarf_tag(&child) == DW_TAG_member && name_of(&child).empty();
        if (!found && (is_unnamed || dwarf_tag(&child) == DW_TAG_inheritance)) {
            found = member_of(type_of(&child), name);
        }
    });
    return found;
}

}  // namespace

bool is_variable(Dwarf_Die* declaration) {
    return dwarf_tag(declaration) != DW_TAG_typedef && !is_structure(declaration);
}

Place place_of(Dwarf_Die variable) {
    Place place{.entry = variable, .file = file_of(&variable)};
    dwarf_decl_line(&variable, &place.line);
    return place;
}

std::optional<Dwarf_Die> Declarations::around(Dwarf_Die entry, std::string const& name) {
    auto scopes = scope_finder_.scopes_around(entry);
    scopes.push_back(entry);
    for (std::size_t i = scopes.size(); i-- > 0;) {
        if (auto found = declared_in(&scopes[i], name)) {
            return found;
        }
        Dwarf_Attribute attribute;
        Dwarf_Die origin;
        for (unsigned const reference : {DW_AT_abstract_origin, DW_AT_specification}) {
            if (dwarf_attr(&scopes[i], reference, &attribute) && dwarf_formref_die(&attribute, &origin)) {
                if (auto found = around(origin, name)) {
                    return found;
                }
            }
        }
    }
    return std::nullopt;
}

std::optional<Dwarf_Die> Declarations::first(std::string const& name, Place const& place) {
    if (name == "mydata") {
        return declared_anywhere(program_, "pogo_user_data_type");
    }
    auto found = around(place.entry, name);
    found = found ? found : declared_above(place, name);
    return found ? found : declared_anywhere(program_, name);
}

std::optional<Declaration> Declarations::meant_by(std::string const& expression, Place const& place) {
    static std::regex const parts(R"([A-Za-z_]\w*|\[\])");
    std::optional<Dwarf_Die> entry;
    std::optional<Dwarf_Die> type;
    for (std::sregex_iterator part(expression.begin(), expression.end(), parts), end; part != end; ++part) {
        if (part->str() == "[]") {
            type = element(type);
            continue;
        }
        entry = entry ? member_of(type, part->str()) : first(part->str(), place);
        if (!entry) {
            return std::nullopt;
        }
        type = is_variable(&*entry) ? type_of(&*entry) : entry;
    }
    return entry ? std::optional(Declaration{*entry, type}) : std::nullopt;
}

}  // namespace shared_state
