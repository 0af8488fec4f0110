// Prints docs/configuration_reference.md from the tables the loader checks by:
//
//     build/release/tests/configuration_reference > docs/configuration_reference.md
#include "config/reference.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "lamps/lamp_types.hpp"
#include "pogosim/version.h"

namespace {

using namespace pogosim;

/// Text for a cell of a Markdown table.
std::string cell(std::string_view text) {
    std::string escaped;
    for (char const c : text) {
        escaped += c == '|' ? "\\|" : c == '<' ? "&lt;" : std::string(1, c);
    }
    return escaped;
}

std::string default_cell(KeyDescription const& key) {
    if (key.required) {
        return "required";
    }
    return key.default_text.empty() ? "" : "`" + key.default_text + "`";
}

void print(KeyGroup const& group) {
    fmt::print("\n## {}{}\n\n", group.path.empty() ? "Top level" : "`" + group.path + "`",
               group.type.empty() ? "" : " of type `" + group.type + "`");
    if (!group.path.empty()) {
        fmt::print("{}\n\n", group.doc);
    }
    fmt::print("| key | value | default | meaning |\n|---|---|---|---|\n");
    for (KeyDescription const& key : group.keys) {
        fmt::print("| `{}` | {} | {} | {} |\n", key.name, cell(key.expected), default_cell(key), cell(key.doc));
    }
}

}  // namespace

int main() {
    fmt::print(
        "# Configuration reference\n\n"
        "Every configuration key of {}, generated from the tables that the loader checks against\n"
        "([configuration_reference.cpp](configuration_reference.cpp)). For explanations, see\n"
        "[configuration.md](configuration.md). Numbers may be written as `1.0e6`. Keys with an empty default are\n"
        "optional and unset.\n",
        POGOSIM_VERSION_STRING);
    for (KeyGroup const& group : configuration_reference(object_types())) {
        print(group);
    }
}
