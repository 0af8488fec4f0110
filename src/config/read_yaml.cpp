// From a file to a tree: what can be wrong with a file is said here.
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

#include "base/error.hpp"
#include "base/log.hpp"
#include "config/tree.hpp"
#include "config/tree_builder.hpp"
#include "config/values.hpp"
#include "config/yaml_text.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kMaxFileBytes = 64U << 20U;

std::string read_text(std::string const& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        throw ConfigError(fmt::format("{}: a folder, expected a YAML configuration file", path));
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
            throw ConfigError(fmt::format("{}: larger than {} MB, not a configuration", path, kMaxFileBytes >> 20U));
        }
    }
    return text;
}

/// Bytes of the UTF-8 character (RFC 3629) that `text` starts with; 0: not UTF-8.
std::size_t utf8_length(std::string_view text) {
    auto const byte = [text](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    auto const follows = [byte](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
    unsigned const first = byte(0);
    unsigned const second = byte(1);
    if (first < 0x80) {
        return 1;
    }
    if (first >= 0xC2 && first < 0xE0) {
        return follows(1) ? 2 : 0;
    }
    if (first >= 0xE0 && first < 0xF0) {
        bool const overlong = first == 0xE0 && second < 0xA0;
        bool const surrogate = first == 0xED && second >= 0xA0;
        return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (first >= 0xF0 && first < 0xF5) {
        bool const overlong = first == 0xF0 && second < 0x90;
        bool const too_large = first == 0xF4 && second >= 0x90;
        return follows(1) && follows(2) && follows(3) && !overlong && !too_large ? 4 : 0;
    }
    return 0;
}

/// YAML is text: UTF-8 without control characters other than tab and line ends.
void require_text(std::string_view text, std::string const& source) {
    int line = 1;
    for (std::size_t i = 0; i < text.size();) {
        auto const byte = static_cast<unsigned char>(text[i]);
        std::size_t const length = utf8_length(text.substr(i));
        bool const control = (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7F;
        if (length == 0 || control) {
            throw ConfigError(
                fmt::format("{}:{}: byte 0x{:02x} is not text; a configuration is UTF-8 text", source, line, byte));
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

/// The parser's messages in other words: what to do about the usual slips.
std::string hint_for(std::string_view message) {
    constexpr std::string_view keys =
        "; the keys of a map begin in the same column, each is followed by a colon and a space, and a text "
        "with ': ' in it needs quotes";
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
    std::string const why = tab ? "this line is indented with a tab, it needs spaces" : error.msg + hint_for(error.msg);
    throw ConfigError(fmt::format("{}:{}: not valid YAML: {}", source, line, why));
}

/// The parser takes what follows a finished map or list for a new document, even without the `---` of one.
void refuse_remains(std::string const& text, int line, std::string const& source) {
    std::string const found = line_of(text, line);
    if (!found.starts_with("---")) {
        throw ConfigError(fmt::format("{}:{}: not valid YAML: '{}' does not belong to what stands above it", source,
                                      line, shown(found)));
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
        TreeBuilder first(source);
        parser.HandleNextDocument(first);
        TreeBuilder second(source);
        if (parser.HandleNextDocument(second)) {
            refuse_remains(text, second.first_line(), source);
            log().warn("{}:{}: a second document starts here; only the first one is used", source, second.first_line());
        }
        return first.root();
    } catch (YAML::Exception const& error) {
        fail_syntax(error, text, source);
    }
}

Node read_yaml_file(std::string const& path) {
    Node root = parse_yaml(read_text(path), path);
    if (root.kind == Node::Kind::null) {
        throw ConfigError(
            fmt::format("{}: the file is empty; a configuration is a map of keys, with at least 'objects'", path));
    }
    if (root.kind != Node::Kind::map) {
        throw ConfigError(
            fmt::format("{}: expected a map of keys at the top level, found {}", root.where(), kind_name(root)));
    }
    return root;
}

}  // namespace pogosim
