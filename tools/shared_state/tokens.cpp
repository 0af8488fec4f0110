#include "tokens.hpp"

#include <cctype>
#include <regex>

namespace shared_state {

Tokens tokens_of(std::string const& text) {
    static std::string const literals = R"re("([^"\\]|\\.)*"|'([^'\\]|\\.)*'|[A-Za-z_]\w*|[0-9][\w.']*)re";
    static std::string const operators = R"re(<<=|>>=|->|::|\+\+|--|<<|>>|&&|\|\||[-+*/%&|^<>=!]=|\S)re";
    static std::regex const token(literals + "|" + operators);
    Tokens found;
    for (std::sregex_iterator match(text.begin(), text.end(), token), end; match != end; ++match) {
        found.push_back(match->str());
    }
    return found;
}

std::vector<Tokens> split_at_commas(Tokens const& tokens) {
    std::vector<Tokens> arguments(1);
    int depth = 0;
    for (std::string const& token : tokens) {
        depth += (token == "(" || token == "[" || token == "{") - (token == ")" || token == "]" || token == "}");
        if (token == "," && depth == 0) {
            arguments.emplace_back();
        } else {
            arguments.back().push_back(token);
        }
    }
    return arguments;
}

bool is_name(std::string const& token) {
    return !token.empty() && (std::isalpha(static_cast<unsigned char>(token[0])) || token[0] == '_');
}

bool is_constant(std::string const& token) {
    bool const is_text = token.starts_with('"') || token.starts_with('\'');
    return is_text || (!token.empty() && std::isdigit(static_cast<unsigned char>(token[0])));
}

}  // namespace shared_state
