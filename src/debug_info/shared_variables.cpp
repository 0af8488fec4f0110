#include "debug_info/shared_variables.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "debug_info/debug_info.hpp"

namespace shared_state {

namespace {

// Finds the variables that a program reads from the configuration.

// Names in an expression that can be variables: not members ("low" in "limits.low"), not what stands in brackets, not
// texts. "&limits::low[i].from" has one: "limits::low".
std::vector<std::string> names_in(std::string expression) {
    static std::regex const brackets(R"(\[[^\[\]]*\])");
    static std::regex const texts(R"("([^"\\]|\\.)*")");
    static std::regex const members(R"((\.|->)\s*[A-Za-z_]\w*)");
    static std::regex const names(R"([A-Za-z_]\w*(\s*::\s*[A-Za-z_]\w*)*)");
    static std::regex const blanks(R"(\s+)");

    expression = std::regex_replace(expression, texts, "");
    for (std::string before; before != expression;) {
        before = expression;
        expression = std::regex_replace(expression, brackets, "");
    }
    expression = std::regex_replace(expression, members, "");
    std::vector<std::string> found;
    for (std::sregex_iterator match(expression.begin(), expression.end(), names), end; match != end; ++match) {
        found.push_back(std::regex_replace(match->str(), blanks, ""));
    }
    return found;
}

using Objects = std::vector<Object const*>;

// Variables of the function itself; nothing if the name means one of its parameters or automatic variables.
Objects in_function(std::string const& name, Note const& note, DebugInfo const& info) {
    Objects found;
    for (auto const& object : info.objects) {
        if (object.function_scope == note.function_scope && object.name == name) {
            found.push_back(&object);
        }
    }
    return found;
}

// Variables outside of functions: those that the note's own file can see, or else those of other files.
Objects outside_functions(std::function<bool(std::string const&)> const& is_meant, Note const& note,
                          DebugInfo const& info) {
    Objects own;
    Objects others;
    for (auto const& object : info.objects) {
        if (!object.function_scope && is_meant(object.qualifier + object.name)) {
            if (object.unit == note.unit) {
                own.push_back(&object);
            } else if (object.external) {
                others.push_back(&object);
            }
        }
    }
    return own.empty() ? others : own;
}

Objects meant_by(std::string const& name, Note const& note, DebugInfo const& info) {
    auto const locals = info.local_to_a_call.find(note.function_scope);
    auto own = in_function(name, note, info);
    if (!own.empty() || (locals != info.local_to_a_call.end() && locals->second.contains(name))) {
        return own;
    }
    // From the function's own namespaces and class outwards.
    for (std::string qualifier = note.qualifier;;) {
        auto found = outside_functions([&](std::string const& full) { return full == qualifier + name; }, note, info);
        if (!found.empty()) {
            return found;
        }
        if (qualifier.empty()) {
            break;
        }
        qualifier.resize(qualifier.size() - 2);
        auto const end = qualifier.rfind("::");
        qualifier.resize(end == std::string::npos ? 0 : end + 2);
    }
    // A using directive, or a base class.
    return outside_functions([&](std::string const& full) { return full.ends_with("::" + name); }, note, info);
}

/// Addresses of the objects that the notes mean, by the rules of C for names: first the function, then the file, then
/// other files. What is behind a pointer is not looked for.
std::set<uint64_t> configured_objects(DebugInfo const& info) {
    std::set<uint64_t> addresses;
    for (auto const& note : info.notes) {
        for (auto const& name : names_in(note.text)) {
            for (Object const* object : meant_by(name, note, info)) {
                if (!object->pointer) {
                    addresses.insert(object->address);
                }
            }
        }
    }
    return addresses;
}

// Shared unintentionally: writable, or set by the first robot that ran the line. (What is outside of functions is set
// before main().)
bool is_suspect(Object const& object, ProgramFile const& program) {
    auto const section = program.section_at(object.address);
    if (!section.writable || section.name.starts_with("pogo_shared")) {
        return false;
    }
    return !object.constant || (object.function_scope != 0 && program.has_guard(program.symbol_at(object.address)));
}

}  // namespace

bool is_in_folders(std::string const& file, std::vector<std::string> const& folders) {
    std::string const place = std::filesystem::weakly_canonical(file).string();
    return std::any_of(folders.begin(), folders.end(),
                       [&](std::string const& folder) { return place.starts_with(folder + "/"); });
}

std::vector<std::string> system_folders() {
    return {"/usr/include", "/usr/lib", "/usr/lib64", "/usr/local/include", "/usr/local/lib"};
}

std::vector<Object> shared_variables(DebugInfo const& info, ProgramFile const& program,
                                     std::vector<std::string> const& ignored_folders) {
    auto const configured = configured_objects(info);
    std::vector<Object> found;
    for (auto const& object : info.objects) {
        if (is_suspect(object, program) && !configured.contains(object.address) &&
            !is_in_folders(object.file, ignored_folders)) {
            found.push_back(object);
        }
    }
    auto const key = [](Object const& object) {
        return std::tie(object.file, object.line, object.column, object.name);
    };
    std::sort(found.begin(), found.end(), [&](Object const& a, Object const& b) { return key(a) < key(b); });
    auto const last =
        std::unique(found.begin(), found.end(), [&](Object const& a, Object const& b) { return key(a) == key(b); });
    found.erase(last, found.end());
    return found;
}

std::string shown_file(std::string const& file) {
    auto const relative = std::filesystem::path(file).lexically_proximate(std::filesystem::current_path());
    return relative.empty() || relative.string().starts_with("..") ? file : relative.string();
}

std::string shown_name(Object const& object) {
    return object.function.empty() ? "'" + object.qualifier + object.name + "'"
                                   : "'" + object.name + "' in " + object.function + "()";
}

}  // namespace shared_state
