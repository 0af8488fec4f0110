// Reads a file into a tree and reports errors in the file.
#include <fmt/format.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/utf8.hpp"
#include "config/looked_up.hpp"
#include "config/tree.hpp"
#include "config/tree_builder.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kMaxFileBytes = 64U << 20U;

std::string read_text(std::string const& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        throw ConfigError(fmt::format("'{}' is a folder; expected a YAML file", path));
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        std::string const reason = std::strerror(errno);
        throw ConfigError(fmt::format("cannot read the configuration '{}': {} (looked for {})", path, reason,
                                      std::filesystem::absolute(path, ignored).string()));
    }
    std::string text;
    std::array<char, 65536> part{};
    while (file.read(part.data(), part.size()) || file.gcount() > 0) {
        text.append(part.data(), static_cast<std::size_t>(file.gcount()));
        if (text.size() > kMaxFileBytes) {
            throw ConfigError(
                fmt::format("'{}' is larger than {} MB; this is not a configuration", path, kMaxFileBytes >> 20U));
        }
    }
    note_text_of(path, text);
    return text;
}

/// YAML is text: UTF-8 without control characters other than tab and line ends.
void require_text(std::string_view text, std::string const& source) {
    int line = 1;
    for (std::size_t i = 0; i < text.size();) {
        auto const byte = static_cast<unsigned char>(text[i]);
        std::size_t const length = first_code_point(text.substr(i)).bytes;
        bool const control = (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7F;
        if (length == 0 || control) {
            throw ConfigError(fmt::format("{}:{}: byte 0x{:02x} is not valid here; a configuration is UTF-8 text",
                                          source, line, byte));
        }
        line += byte == '\n' ? 1 : 0;
        i += length;
    }
}

int line_count(std::string const& text) {
    bool const has_open_line = !text.empty() && text.back() != '\n';
    return static_cast<int>(std::ranges::count(text, '\n')) + (has_open_line ? 1 : 0);
}

std::string line_of(std::string const& text, int number) {
    std::istringstream stream(text);
    std::string line;
    for (int i = 0; i < number; ++i) {
        std::getline(stream, line);
    }
    return line;
}

/// Hints added to the parser's messages: how to fix common mistakes.
std::string hint_for(std::string_view message) {
    constexpr std::string_view keys =
        "; the keys of a map must start in the same column, each followed by a colon and a space, and a "
        "string containing ': ' needs quotes";
    constexpr std::array<std::pair<std::string_view, std::string_view>, 4> hints{{
        {"end of map not found", keys},
        {"illegal map value", keys},
        {"end of map flow not found", "; is a '}' or a comma missing?"},
        {"end of sequence flow not found", "; is a ']' or a comma missing?"},
    }};
    auto const* const found = std::ranges::find(hints, message, &std::pair<std::string_view, std::string_view>::first);
    return found == hints.end() ? "" : std::string(found->second);
}

[[noreturn]] void fail_syntax(YAML::Exception const& error, std::string const& text, std::string const& source) {
    // The end mark adds lines that the user does not have.
    int const line = std::clamp(error.mark.line + 1, 1, std::max(1, line_count(text)));
    std::string const found = line_of(text, line);
    bool const tab = found.substr(0, found.find_first_not_of(" \t")).find('\t') != std::string::npos;
    std::string const why = tab ? "this line is indented with a tab; use spaces" : error.msg + hint_for(error.msg);
    throw ConfigError(fmt::format("{}:{}: not valid YAML: {}", source, line, why));
}

/// The parser treats whatever follows a complete map or list as a new document, even without `---`.
void refuse_remains(std::string const& text, int line, std::string const& source) {
    std::string const found = line_of(text, line);
    if (!found.starts_with("---")) {
        throw ConfigError(fmt::format("{}:{}: not valid YAML: '{}' is not part of the structure above it", source, line,
                                      shown(found)));
    }
}

char const* kind_name(Node const& node) {
    return node.kind == Node::Kind::sequence ? "a list" : "a single value";
}

}  // namespace

Node parse_yaml(std::string const& text, std::string const& source) {
    require_text(text, source);
    try {
        std::istringstream stream(text + (text.ends_with('\n') ? "" : "\n") + std::string(kEndMark));
        YAML::Parser parser(stream);
        TreeBuilder first(text, source);
        bool const has_value = parser.HandleNextDocument(first);
        TreeBuilder second(text, source);
        if (parser.HandleNextDocument(second)) {
            refuse_remains(text, second.first_line(), source);
            log().warn("{}:{}: a second document starts here; only the first one is used", source, second.first_line());
        }
        Node root = first.root();
        root.blank = root.blank || !has_value;
        return root;
    } catch (YAML::Exception const& error) {
        fail_syntax(error, text, source);
    }
}

Node read_yaml_file(std::string const& path, std::string_view content) {
    Node root = parse_yaml(read_text(path), path);
    if (root.kind == Node::Kind::null) {
        throw ConfigError(fmt::format("{}: the file is empty; {}", path, content));
    }
    if (root.kind != Node::Kind::map) {
        throw ConfigError(
            fmt::format("{}: expected a map of keys at the top level, found {}", root.where(), kind_name(root)));
    }
    return root;
}

}  // namespace pogosim
