#include "expression.hpp"

#include <set>
#include <string_view>

#include "tokens.hpp"

namespace shared_state {

namespace {

using Words = std::set<std::string_view>;

struct CannotFollow {};

Words const kQualifiers{"const", "volatile", "restrict", "__restrict", "_Atomic", "typename"};
Words const kTags{"struct", "union", "class", "enum"};
Words const kBasicTypes{"void",   "char",   "short",    "int",  "long", "float",
                        "double", "signed", "unsigned", "bool", "_Bool"};
Words const kBytes{"void", "char", "uint8_t", "int8_t", "byte"};
Words const kCasts{"static_cast", "reinterpret_cast", "const_cast", "dynamic_cast"};
Words const kAssignments{"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="};
Words const kComparisons{"<<", ">>", "<", ">", "<=", ">=", "==", "!=", "&", "^", "|", "&&", "||"};
Words const kSums{"+", "-"};
Words const kProducts{"*", "/", "%"};
Words const kSigns{"+", "-", "!", "~", "++", "--", "__extension__"};

struct Type {
    Value value;
    bool is_certain = false;  // else it may be the name of a variable
    bool is_of_bytes = false;
};

// One method for each rule of the grammar, from those that bind least.
class Reader {
public:
    Reader(Tokens tokens, FindName const& find_name) : tokens_(std::move(tokens)), find_name_(find_name) {}

    Expression read() {
        Values const values = conditional();
        if (at_ != tokens_.size()) {
            throw CannotFollow{};
        }
        return {values, sizes_};
    }

private:
    std::string const& token(std::size_t ahead = 0) const {
        static std::string const none;
        return at_ + ahead < tokens_.size() ? tokens_[at_ + ahead] : none;
    }

    bool take(std::string_view wanted) {
        bool const is_here = token() == wanted;
        at_ += is_here ? 1 : 0;
        return is_here;
    }

    bool take_one_of(Words const& words) {
        bool const is_here = words.contains(token());
        at_ += is_here ? 1 : 0;
        return is_here;
    }

    void expect(std::string_view wanted) {
        if (!take(wanted)) {
            throw CannotFollow{};
        }
    }

    Values conditional() {
        Values const values = comparison();
        if (take_one_of(kAssignments)) {
            conditional();
            return values;
        }
        if (!take("?")) {
            return values;
        }
        Values const first = token() == ":" ? values : list();
        expect(":");
        return together(first, conditional());
    }

    // Expressions with commas between them: the last one counts.
    Values list() {
        Values values = conditional();
        while (take(",")) {
            values = conditional();
        }
        return values;
    }

    // Operands with operators between them whose result is no object of the program.
    Values operation(Words const& operators, Values (Reader::*operand)()) {
        Values values = (this->*operand)();
        while (take_one_of(operators)) {
            (this->*operand)();
            values.clear();
        }
        return values;
    }

    Values comparison() { return operation(kComparisons, &Reader::sum); }

    Values sum() {
        Values values = product();
        while (take_one_of(kSums)) {
            Values const left = each(values, moved);
            Values const right = each(product(), moved);
            values = left.empty() || right.empty() ? together(left, right) : Values{};
        }
        return values;
    }

    Values product() { return operation(kProducts, &Reader::unary); }

    Values unary() {
        if (take("&")) {
            return each(unary(), address_of);
        }
        if (take("*")) {
            return each(unary(), dereferenced);
        }
        if (take("sizeof")) {
            return size();
        }
        if (take_one_of(kSigns)) {
            unary();
            return {};
        }
        if (auto const type = type_in_parentheses()) {
            return token() == "{" ? literal(*type) : cast(*type, unary());
        }
        return postfix();
    }

    Values size() {
        auto const type = type_in_parentheses();
        Values operands = type ? Values{type->value} : unary();
        for (Value& operand : operands) {
            operand.is_size = true;
        }
        std::erase_if(operands, [](Value const& operand) { return !operand.base && operand.layers.empty(); });
        sizes_ = together(sizes_, operands);
        return operands;
    }

    Values literal(Type const& type) {
        std::size_t depth = 0;
        do {
            depth += token() == "{" ? 1 : 0;
            depth -= token() == "}" ? 1 : 0;
            at_++;
        } while (depth > 0 && at_ < tokens_.size());
        return {type.value};
    }

    // Bytes stay those of the object, and a size remains one.
    static Values cast(Type const& type, Values values) {
        if (type.is_of_bytes) {
            std::erase_if(values, [](Value const& value) { return value.layers.empty() || value.is_size; });
            for (Value& value : values) {
                value.as_bytes = true;
            }
        } else if (type.value.layers.empty()) {
            std::erase_if(values, [](Value const& value) { return !value.is_size; });
        } else {
            values = {type.value};
            values[0].declaration = std::nullopt;
        }
        return values;
    }

    Values postfix() {
        Values values = primary();
        for (;;) {
            if (take("[")) {
                list();
                expect("]");
                values = each(values, dereferenced);
            } else if (token() == "." || token() == "->") {
                if (take("->")) {
                    values = each(values, dereferenced);
                } else {
                    take(".");
                }
                std::string const name = last_name();
                values = each(values, [&](Value const& value) { return member_of(value, name); });
            } else if (token() == "(") {
                arguments();
                values.clear();
            } else if (!take("++") && !take("--")) {
                return values;
            }
        }
    }

    Values primary() {
        if (take("(")) {
            Values values = list();
            expect(")");
            return values;
        }
        if (token() == "this" && token(1) == "->") {
            at_ += 2;
        }
        if (take_one_of(kCasts)) {
            expect("<");
            auto const wanted = type();
            expect(">");
            expect("(");
            Values const values = list();
            expect(")");
            return wanted ? cast(*wanted, values) : Values{};
        }
        if (is_name(token()) || token() == "::") {
            return named();
        }
        if (!is_constant(token())) {
            throw CannotFollow{};
        }
        at_++;
        return {};
    }

    Values named() {
        auto declaration = find_name_(last_name());
        if (!declaration) {
            return {};
        }
        if (is_type(&*declaration)) {
            Type const wanted{.value = value_of_type(declaration, declaration), .is_certain = true};
            return token() == "(" ? cast(wanted, arguments()) : Values{};
        }
        return {value_of_type(type_of(&*declaration), declaration)};
    }

    // Values of the last one.
    Values arguments() {
        expect("(");
        Values values;
        while (!take(")")) {
            values = conditional();
            if (token() != ")") {
                expect(",");
            }
        }
        return values;
    }

    // Without namespaces and classes in front of it.
    std::string last_name() {
        take("::");
        std::string name = token();
        if (!is_name(name)) {
            throw CannotFollow{};
        }
        at_++;
        while (take("::")) {
            name = token();
            at_++;
        }
        return name;
    }

    std::optional<Type> type_in_parentheses() {
        std::size_t const start = at_;
        if (take("(")) {
            if (auto const found = type(); found && take(")")) {
                std::string const& next = token();
                if (found->is_certain || is_name(next) || is_constant(next)) {
                    return found;
                }
            }
        }
        at_ = start;
        return std::nullopt;
    }

    std::optional<Type> type() {
        Type type;
        bool has_tag = false;
        bool has_basic = false;
        bool has_bytes = false;
        std::string name;
        for (bool goes_on = true; goes_on && (is_name(token()) || token() == "::");) {
            has_bytes = has_bytes || kBytes.contains(token());
            if (take_one_of(kTags)) {
                has_tag = true;
            } else if (take_one_of(kBasicTypes)) {
                has_basic = true;
            } else if (!take_one_of(kQualifiers)) {
                goes_on = name.empty() && !has_basic;
                if (goes_on) {
                    name = last_name();
                    has_bytes = has_bytes || kBytes.contains(name);
                }
            }
        }
        auto declaration = name.empty() ? std::nullopt : find_name_(name);
        bool const is_found = declaration && is_type(&*declaration);
        if (is_found) {
            type.value = value_of_type(declaration, declaration);
        } else if (name.empty() && !has_basic) {
            return std::nullopt;
        }
        std::size_t const before = type.value.layers.size();
        while (token() == "*" || token() == "&" || token() == "&&" || kQualifiers.contains(token())) {
            if (token() == "*") {
                type.value.layers.insert(type.value.layers.begin(), Value::Layer{true, std::nullopt});
            }
            at_++;
        }
        bool const has_stars = type.value.layers.size() > before;
        while (take("[")) {
            if (token() != "]") {
                list();
            }
            expect("]");
            type.value.layers.insert(type.value.layers.begin(), Value::Layer{false, std::nullopt});
        }
        type.is_certain = is_found || has_tag || has_basic || has_stars;
        type.is_of_bytes = type.value.layers.size() == 1 && type.value.layers[0].is_pointer &&
                           (has_bytes || (type.value.base && dwarf_bytesize(&type.value.base->type) == 1));
        return type;
    }

    Tokens tokens_;
    FindName const& find_name_;
    std::size_t at_ = 0;
    Values sizes_;
};

}  // namespace

std::vector<Expression> read_arguments(std::string const& text, FindName const& find_name) {
    std::vector<Expression> found;
    for (Tokens const& argument : split_at_commas(tokens_of(text))) {
        try {
            found.push_back(Reader(argument, find_name).read());
        } catch (CannotFollow const&) {
            found.emplace_back();
        }
    }
    return found;
}

}  // namespace shared_state
