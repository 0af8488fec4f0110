#include "payloads.hpp"

#include <algorithm>
#include <regex>

namespace shared_state {

namespace {

// The end of the comment or text that begins at `at`; `at` if none does.
std::size_t end_of_comment(std::string const& text, std::size_t at) {
    auto const behind = [&](char const* end) {
        std::size_t const found = text.find(end, at + 2);
        return found == std::string::npos ? text.size() : found + std::char_traits<char>::length(end);
    };
    if (text.compare(at, 2, "//") == 0) {
        return std::min(text.find('\n', at), text.size());
    }
    if (text.compare(at, 2, "/*") == 0) {
        return behind("*/");
    }
    if (text[at] != '"' && text[at] != '\'') {
        return at;
    }
    std::size_t end = at + 1;
    while (end < text.size() && text[end] != text[at] && text[end] != '\n') {
        end += text[end] == '\\' ? 2 : 1;
    }
    return std::min(end + 1, text.size());
}

// With blanks in place of comments and texts.
void blank_out_comments(std::string& text) {
    for (std::size_t at = 0; at < text.size(); at++) {
        std::size_t const end = end_of_comment(text, at);
        for (; at < end; at++) {
            text[at] = text[at] == '\n' ? '\n' : ' ';
        }
    }
}

// The bracket that closes the one at `open`.
std::size_t closing(std::string const& text, std::size_t open) {
    int depth = 0;
    for (std::size_t i = open; i < text.size(); i++) {
        depth += (text[i] == '(') - (text[i] == ')');
        if (depth == 0) {
            return i;
        }
    }
    return text.size();
}

// "message->payload", "(*message).payload", "mydata->inbox[i + 1].payload", and what is in front of it.
std::string const message =
    R"(((?:\(\s*\*\s*)?[A-Za-z_]\w*(?:\s*(?:\[[^\[\]]*\]|(?:\.|->)\s*[A-Za-z_]\w*))*?\)?)\s*(?:->|\.)\s*payload\b)";
// "(beacon_t const*)" or "reinterpret_cast<beacon_t const*>(", and the type in it.
std::string const words = R"((?:(?:const|volatile|struct|union|class)\b\s*)*)";
std::string const cast =
    R"([(<]\s*)" + words + R"(([A-Za-z_][\w:]*)\s*)" + words + R"([*&][\s*&]*)" + words + R"((?:\)|>\s*\())";
std::string const brackets_and_casts = R"((?:[\s(&*]|\([^()]*\*\s*\)|\w+_cast\s*<[^<>]*>)*)";

void find_copies(std::string const& statement, std::vector<PayloadUse>& found) {
    static std::regex const copy(R"(\b(?:memcpy|memmove|copy|copy_n)\s*\()");
    static std::regex const payload(message);
    for (std::sregex_iterator match(statement.begin(), statement.end(), copy), end; match != end; ++match) {
        auto const open = static_cast<std::size_t>(match->position() + match->length() - 1);
        std::string const arguments = statement.substr(open + 1, closing(statement, open) - open - 1);
        std::smatch part;
        if (std::regex_search(arguments, part, payload)) {
            found.push_back({.message = part.str(1), .arguments = arguments});
        }
    }
}

void find_casts(std::string const& statement, std::vector<PayloadUse>& found) {
    static std::regex const type(cast + brackets_and_casts + message);
    for (std::sregex_iterator match(statement.begin(), statement.end(), type), end; match != end; ++match) {
        found.push_back({.message = match->str(2), .arguments = "sizeof(" + match->str(1) + ")"});
    }
}

// "beacon = (void*)message->payload"
void find_pointers(std::string const& statement, std::vector<PayloadUse>& found) {
    static std::regex const pointer(R"(\b([A-Za-z_]\w*)\s*=\s*)" + brackets_and_casts + message);
    for (std::sregex_iterator match(statement.begin(), statement.end(), pointer), end; match != end; ++match) {
        found.push_back({.message = match->str(2), .arguments = match->str(1)});
    }
}

// After "bytes = message->payload;", "bytes" is a payload to the end of the function.
void replace_name_of_payload(std::string const& statement, std::string& text, std::size_t end) {
    static std::regex const naming(R"(\b(?!payload\b)([A-Za-z_]\w*)\s*=\s*(?:\([^()]*\*[^()]*\)\s*)?()" + message +
                                   R"()\s*(?:\+.*)?$)");
    std::smatch match;
    if (std::regex_search(statement, match, naming)) {
        std::size_t const length = std::min(text.find("\n}", end), text.size()) - end;
        std::regex const name("\\b" + match.str(1) + "\\b");
        text.replace(end, length, std::regex_replace(text.substr(end, length), name, match.str(2)));
    }
}

}  // namespace

std::vector<PayloadUse> payload_uses(std::string text) {
    blank_out_comments(text);
    std::vector<PayloadUse> all;
    for (std::size_t at = text.find("payload"); at != std::string::npos; at = text.find("payload", at)) {
        std::size_t const before = text.find_last_of(";{}", at);
        std::size_t const start = before == std::string::npos ? 0 : before + 1;
        std::size_t const end = std::min(text.find_first_of(";{}", at), text.size());
        std::string const statement = text.substr(start, end - start);
        std::vector<PayloadUse> found;
        find_copies(statement, found);
        find_casts(statement, found);
        find_pointers(statement, found);
        for (auto& use : found) {
            use.message = std::regex_replace(use.message, std::regex(R"(\[[^\]]*\])"), "[]");
            use.line =
                1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
            all.push_back(use);
        }
        replace_name_of_payload(statement, text, end);
        at = end;
    }
    return all;
}

}  // namespace shared_state
