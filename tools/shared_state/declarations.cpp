#include "declarations.hpp"

#include <dwarf.h>

#include <regex>

#include "debug_info/debug_info.hpp"
#include "types.hpp"

namespace shared_state {

namespace {

bool is_variable_or_parameter(Dwarf_Die* entry) {
    return dwarf_tag(entry) == DW_TAG_variable || dwarf_tag(entry) == DW_TAG_formal_parameter;
}

// What a name can stand for.
bool is_declaration(Dwarf_Die* entry) {
    int const tag = dwarf_tag(entry);
    return is_variable_or_parameter(entry) || tag == DW_TAG_member || tag == DW_TAG_typedef || is_structure(entry);
}

// A variable hides a type of the same name.
std::optional<Dwarf_Die> declared_among(std::vector<Dwarf_Die> const& entries, std::string const& name) {
    std::optional<Dwarf_Die> found;
    for (Dwarf_Die entry : entries) {
        bool const is_meant = is_declaration(&entry) && name_of(&entry) == name;
        if (is_meant && (!found || dwarf_tag(&*found) != DW_TAG_variable)) {
            found = entry;
        }
    }
    return found;
}

}  // namespace

bool is_variable(Dwarf_Die* declaration) {
    return dwarf_tag(declaration) != DW_TAG_typedef && !is_structure(declaration);
}

Declarations::Declarations(ProgramFile const& program) {
    for_each_unit(program.debug_info(), [&](Dwarf_Die& unit) { read(&unit, /*is_inside=*/false); });
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
        if (auto found = declared_among(scope_finder_.children_of(&scopes[i]), name)) {
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

void Declarations::read(Dwarf_Die* scope, bool is_inside) {
    for_each_child(scope, [&](Dwarf_Die& child) {
        int const tag = dwarf_tag(&child);
        if (is_variable_or_parameter(&child)) {
            variables_[name_of(&child)].push_back(child);
        }
        if (!is_inside && is_declaration(&child)) {
            auto const [place, is_new] = outside_functions_.try_emplace(name_of(&child), child);
            if (!is_new && tag == DW_TAG_variable && dwarf_tag(&place->second) != DW_TAG_variable) {
                place->second = child;
            }
        }
        read(&child, is_inside || tag != DW_TAG_namespace);
    });
}

// The last variable of this name above a place in its file: clang puts a note into its function, not into the block,
// and optimised code may not tell the function either.
std::optional<Dwarf_Die> Declarations::above(Place const& place, std::string const& name) {
    std::optional<Dwarf_Die> found;
    int found_line = 0;
    for (Dwarf_Die& variable : variables_[name]) {
        int line = 0;
        if (dwarf_decl_line(&variable, &line) == 0 && line <= place.line && line > found_line &&
            file_of(&variable) == place.file) {
            found = variable;
            found_line = line;
        }
    }
    return found;
}

// clang does not tell what is declared in one file and defined in another.
std::optional<Dwarf_Die> Declarations::anywhere(std::string const& name) {
    auto const found = outside_functions_.find(name);
    return found != outside_functions_.end() ? std::optional(found->second) : std::nullopt;
}

std::optional<Dwarf_Die> Declarations::first(std::string const& name, Place const& place) {
    if (name == "mydata") {
        return anywhere("pogo_user_data_type");
    }
    auto found = around(place.entry, name);
    found = found ? found : above(place, name);
    return found ? found : anywhere(name);
}

std::optional<Dwarf_Die> Declarations::member_of(std::optional<Dwarf_Die> type, std::string const& name) {
    auto basic = basic_type(type, /*through_pointers=*/true);
    if (!basic || !is_structure(&basic->type)) {
        return std::nullopt;
    }
    auto found = declared_among(scope_finder_.children_of(&basic->type), name);
    for_each_child(&basic->type, [&](Dwarf_Die child) {
        bool const is_unnamed = dwarf_tag(&child) == DW_TAG_member && name_of(&child).empty();
        if (!found && (is_unnamed || dwarf_tag(&child) == DW_TAG_inheritance)) {
            found = member_of(type_of(&child), name);
        }
    });
    return found;
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
