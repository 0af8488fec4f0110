#include "sent_objects.hpp"

#include <dwarf.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <regex>

#include "debug_info/debug_info.hpp"

namespace shared_state {

namespace {

// A name in the arguments, with the members that follow it, and what is done with it.
struct Mention {
    std::string text;  // "mydata->states[].part"
    bool by_address = false;
    bool by_size = false;
    int dereferenced = 0;
};

std::string replaced(std::string text, std::regex const& what, char const* replacement) {
    for (std::string before; before != text;) {
        before = text;
        text = std::regex_replace(text, what, replacement);
    }
    return text;
}

// Without what does not tell what is sent: texts, indices, arguments of other functions, "struct", "swarm::".
std::string without_details(std::string text) {
    static std::regex const texts(R"re("([^"\\]|\\.)*"|'([^'\\]|\\.)*')re");
    static std::regex const indices(R"(\s*\[[^\[\]]+\])");
    static std::regex const words(R"(\b(struct|union|class|const|volatile)\b|[A-Za-z_]\w*\s*::|\bthis\s*->)");
    static std::regex const calls(R"(\b(?!sizeof\b)[A-Za-z_]\w*\s*\([^()]*\))");
    text = std::regex_replace(text, texts, "");
    text = replaced(text, indices, "[]");
    return replaced(std::regex_replace(text, words, ""), calls, "");
}

// Where the last argument begins: the number of bytes.
std::size_t start_of_size(std::string const& arguments) {
    int depth = 0;
    for (std::size_t i = arguments.size(); i-- > 0;) {
        char const c = arguments[i];
        depth += (c == ')' || c == '}') - (c == '(' || c == '{');
        if (c == ',' && depth == 0) {
            return i;
        }
    }
    return arguments.size();
}

std::vector<Mention> mentions_in(std::string const& arguments) {
    static std::regex const mention(
        R"((sizeof\b[\s(]*)?(&\s*\(*)?((?:\*\s*)*)([A-Za-z_]\w*(?:\[\])*(?:\s*(?:\.|->)\s*[A-Za-z_]\w*(?:\[\])*)*))");
    std::string const text = without_details(arguments);
    auto const size = static_cast<std::ptrdiff_t>(start_of_size(text));
    std::vector<Mention> found;
    for (std::sregex_iterator match(text.begin(), text.end(), mention), end; match != end; ++match) {
        Mention const one{.text = std::regex_replace(match->str(4), std::regex(R"(\s+)"), ""),
                          .by_address = (*match)[2].matched,
                          .by_size = (*match)[1].matched,
                          .dereferenced = static_cast<int>(std::count((*match)[3].first, (*match)[3].second, '*'))};
        if (one.by_size || match->position() < size) {
            found.push_back(one);
        }
    }
    return found;
}

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

std::optional<Dwarf_Die> declared_around(Dwarf_Die entry, std::string const& name) {
    Dwarf_Attribute attribute;
    Dwarf_Die origin;
    for (unsigned const reference : {DW_AT_abstract_origin, DW_AT_specification}) {
        if (dwarf_attr(&entry, reference, &attribute) && dwarf_formref_die(&attribute, &origin)) {
            if (auto found = declared_around(origin, name)) {
                return found;
            }
        }
    }
    Dwarf_Die* scopes = nullptr;
    int const count = dwarf_getscopes_die(&entry, &scopes);
    std::unique_ptr<Dwarf_Die, decltype(&std::free)> const owned(scopes, std::free);
    for (int i = 1; i < count; i++) {
        if (auto found = declared_in(&scopes[i], name)) {
            return found;
        }
        bool const is_elsewhere = dwarf_hasattr(&scopes[i], DW_AT_abstract_origin) != 0 ||
                                  dwarf_hasattr(&scopes[i], DW_AT_specification) != 0;
        if (is_elsewhere) {
            if (auto found = declared_around(scopes[i], name)) {
                return found;
            }
        }
    }
    return std::nullopt;
}

// The last variable of this name above the note in its file: clang puts a note into its function, not into the block,
// and optimised code may not tell the function either.
std::optional<Dwarf_Die> declared_above(Dwarf_Die* note, std::string const& name) {
    Dwarf_Die unit;
    int last_line = 0;
    dwarf_decl_line(note, &last_line);
    if (!dwarf_diecu(note, &unit, nullptr, nullptr)) {
        return std::nullopt;
    }
    std::optional<Dwarf_Die> found;
    int found_line = 0;
    std::function<void(Dwarf_Die)> const look_at = [&](Dwarf_Die entry) {
        int const tag = dwarf_tag(&entry);
        int line = 0;
        if ((tag == DW_TAG_variable || tag == DW_TAG_formal_parameter) && name_of(&entry) == name &&
            dwarf_decl_line(&entry, &line) == 0 && line <= last_line && line > found_line &&
            file_of(&entry) == file_of(note)) {
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
        found = found ? found : declared_in(&scope, name);
        for_each_child(&scope, [&](Dwarf_Die child) {
            if (!found && dwarf_tag(&child) == DW_TAG_namespace) {
                look_in(child);
            }
        });
    };
    Dwarf_CU* unit = nullptr;
    Dwarf_CU* next = nullptr;
    Dwarf_Die entry;
    while (!found && dwarf_get_units(program.debug_info(), unit, &next, nullptr, nullptr, &entry, nullptr) == 0) {
        look_in(entry);
        unit = next;
    }
    return found;
}

bool is_variable(Dwarf_Die* declaration) {
    return dwarf_tag(declaration) != DW_TAG_typedef && !is_structure(declaration);
}

// Without typedef and const.
std::optional<Dwarf_Die> unnamed(std::optional<Dwarf_Die> type) {
    while (type) {
        switch (dwarf_tag(&*type)) {
            case DW_TAG_typedef:
            case DW_TAG_const_type:
            case DW_TAG_volatile_type:
            case DW_TAG_reference_type:
            case DW_TAG_rvalue_reference_type:
                type = type_of(&*type);
                break;
            default:
                return type;
        }
    }
    return type;
}

bool is_array(Dwarf_Die* type) {
    return dwarf_tag(type) == DW_TAG_array_type;
}

// What `[i]` and `*` make of a type. Rows of an array stay an array.
std::optional<Dwarf_Die> element(std::optional<Dwarf_Die> type) {
    auto bare = unnamed(type);
    if (!bare || (!is_array(&*bare) && !is_pointer(&*bare))) {
        return std::nullopt;
    }
    int dimensions = 0;
    for_each_child(&*bare, [&](Dwarf_Die child) { dimensions += dwarf_tag(&child) == DW_TAG_subrange_type; });
    return dimensions > 1 ? bare : type_of(&*bare);
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

std::optional<Dwarf_Die> first_declaration(std::string const& name, Dwarf_Die* note, ProgramFile const& program) {
    if (name == "mydata") {
        return declared_anywhere(program, "pogo_user_data_type");
    }
    auto found = declared_around(*note, name);
    found = found ? found : declared_above(note, name);
    return found ? found : declared_anywhere(program, name);
}

std::optional<SentObject> object_of(Mention const& mention, Dwarf_Die* note, ProgramFile const& program) {
    static std::regex const parts(R"([A-Za-z_]\w*|\[\])");
    std::optional<Dwarf_Die> declaration;
    std::optional<Dwarf_Die> type;
    for (std::sregex_iterator part(mention.text.begin(), mention.text.end(), parts), end; part != end; ++part) {
        if (part->str() == "[]") {
            type = element(type);
            continue;
        }
        declaration =
            part->position() == 0 ? first_declaration(part->str(), note, program) : member_of(type, part->str());
        if (!declaration) {
            return std::nullopt;
        }
        type = is_variable(&*declaration) ? type_of(&*declaration) : declaration;
    }
    for (int i = 0; i < mention.dereferenced; i++) {
        type = element(type);
    }
    auto bare = unnamed(type);
    if (!bare || (!is_variable(&*declaration) && !mention.by_size)) {
        return std::nullopt;
    }
    if (!mention.by_address && is_pointer(&*bare)) {
        type = type_of(&*bare);  // `sizeof` of a pointer is a slip of another kind
    } else if (!mention.by_address && !mention.by_size && !is_array(&*bare)) {
        return std::nullopt;  // an offset
    } else if (!is_pointer(&*bare) && !is_array(&*bare) && is_pointer(&*type)) {
        type = bare;  // a reference
    }
    auto const basic = basic_type(type, /*through_pointers=*/false);
    return basic ? std::optional(SentObject{mention.text, *declaration, *basic}) : std::nullopt;
}

}  // namespace

bool is_note_of_sending(Dwarf_Die* variable) {
    return name_of(variable) == "pogosim_sent_arguments";
}

std::vector<SentObject> sent_objects(Dwarf_Die* note, ProgramFile const& program) {
    std::vector<SentObject> found;
    if (auto const address = address_of(note)) {
        for (auto const& mention : mentions_in(program.text_at(*address))) {
            if (auto const object = object_of(mention, note, program)) {
                found.push_back(*object);
            }
        }
    }
    return found;
}

}  // namespace shared_state
