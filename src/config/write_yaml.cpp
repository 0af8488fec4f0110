// From a tree to YAML text that this reader, PyYAML and every other YAML 1.1 or 1.2 reader understand alike: block
// style, and double quotes around everything that is not plainly harmless.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "base/utf8.hpp"
#include "config/tree.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kMaxSimpleKey = 1000;  // longer keys need the "? key" form; YAML's limit is 1024

bool is_letter_or_digit(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// Characters that mean nothing to YAML wherever they stand, and at least one that keeps it from being "-" or "---".
bool is_harmless(std::string_view text) {
    auto const allowed = [](char c) {
        return is_letter_or_digit(c) || std::string_view("_./+-").find(c) != std::string_view::npos;
    };
    return std::ranges::all_of(text, allowed) && std::ranges::any_of(text, is_letter_or_digit);
}

bool looks_like_null(std::string_view text) {
    return text == "null" || text == "Null" || text == "NULL";
}

/// YAML's printable characters, less the line separators that a reader would fold and the byte order mark.
bool is_printable(char32_t c) {
    return (c >= 0x20 && c < 0x7F) || (c >= 0xA0 && c < 0xD800 && c != 0x2028 && c != 0x2029) ||
           (c >= 0xE000 && c < 0xFFFE && c != 0xFEFF) || c >= 0x10000;
}

std::string escape(char32_t c) {
    auto const number = static_cast<unsigned>(c);
    if (number <= 0xFF) {
        return fmt::format("\\x{:02x}", number);
    }
    return number <= 0xFFFF ? fmt::format("\\u{:04x}", number) : fmt::format("\\U{:08x}", number);
}

std::string in_quotes(std::string_view text) {
    std::string quoted = "\"";
    while (!text.empty()) {
        CodePoint const c = first_code_point(text);
        if (c.value == '"' || c.value == '\\') {
            quoted += '\\';
            quoted += text.front();
        } else if (c.value == '\n') {
            quoted += "\\n";
        } else if (c.value == '\t') {
            quoted += "\\t";
        } else if (c.bytes > 0 && is_printable(c.value)) {
            quoted += text.substr(0, c.bytes);
        } else {
            quoted += escape(c.value);
        }
        text.remove_prefix(std::max<std::size_t>(c.bytes, 1));
    }
    return quoted + '"';
}

std::string scalar_text(Node const& node) {
    return !node.quoted && is_harmless(node.scalar) ? node.scalar : in_quotes(node.scalar);
}

std::string key_text(std::string const& key) {
    return is_harmless(key) && !looks_like_null(key) ? key : in_quotes(key);
}

void write(std::string& out, Node const& node, std::size_t indent);

/// Writes what stands behind "key:" or "-", on the same line if it fits there.
void write_value(std::string& out, Node const& node, std::size_t indent) {
    bool const is_block = !node.entries.empty() || !node.items.empty();
    out += is_block ? "\n" : " ";
    write(out, node, indent);
}

void write(std::string& out, Node const& node, std::size_t indent) {
    std::string const margin(indent, ' ');
    switch (node.kind) {
        case Node::Kind::null:
            out += "null\n";
            return;
        case Node::Kind::scalar:
            out += scalar_text(node) + '\n';
            return;
        case Node::Kind::sequence:
            if (node.items.empty()) {
                out += "[]\n";
            }
            for (Node const& item : node.items) {
                // The first line of a map or list shares the line of the dash.
                std::string block;
                write(block, item, indent + 2);
                bool const is_block = !item.entries.empty() || !item.items.empty();
                out += margin + "- " + block.substr(is_block ? indent + 2 : 0);
            }
            return;
        case Node::Kind::map:
            if (node.entries.empty()) {
                out += "{}\n";
            }
            for (auto const& [key, value] : node.entries) {
                std::string const text = key_text(key);
                out += text.size() > kMaxSimpleKey ? fmt::format("{0}? {1}\n{0}:", margin, text)
                                                   : fmt::format("{}{}:", margin, text);
                write_value(out, value, indent + 2);
            }
            return;
    }
}

}  // namespace

std::string to_yaml(Node const& root) {
    std::string text;
    write(text, root, 0);
    return text;
}

}  // namespace pogosim
