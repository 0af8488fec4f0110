#include "sim/condition.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "base/number_from.hpp"

namespace pogosim {

namespace {

/// Truth values are 1 and 0.
using Operation = float (*)(float a, float b);

}  // namespace

/// A number, a value of a robot, or an operation on one or two others.
struct ConditionNode {
    float number = 0.0F;
    std::optional<std::size_t> value{};  // index into the names
    Operation operation = nullptr;
    std::unique_ptr<ConditionNode const> a{};
    std::unique_ptr<ConditionNode const> b{};

    float evaluate(std::span<float const* const> values, std::size_t robot) const {
        if (operation != nullptr) {
            return operation(a->evaluate(values, robot), b != nullptr ? b->evaluate(values, robot) : 0.0F);
        }
        return value ? values[*value][robot] : number;
    }
};

namespace {

using Tree = std::unique_ptr<ConditionNode const>;

struct Operator {
    std::string_view sign;
    Operation operation;
};

float truth(bool value) {
    return value ? 1.0F : 0.0F;
}

/// What is not there is not true.
bool is_true(float value) {
    return value != 0.0F && !std::isnan(value);
}

// Lowest precedence first. A sign that is the beginning of another one comes after it.
constexpr std::array kOr{Operator{"or", [](float a, float b) { return truth(is_true(a) || is_true(b)); }}};
constexpr std::array kAnd{Operator{"and", [](float a, float b) { return truth(is_true(a) && is_true(b)); }}};
constexpr std::array kComparisons{Operator{"<=", [](float a, float b) { return truth(a <= b); }},
                                  Operator{">=", [](float a, float b) { return truth(a >= b); }},
                                  Operator{"==", [](float a, float b) { return truth(a == b); }},
                                  Operator{"!=", [](float a, float b) { return truth(a < b || a > b); }},
                                  Operator{"<", [](float a, float b) { return truth(a < b); }},
                                  Operator{">", [](float a, float b) { return truth(a > b); }}};
constexpr std::array kSums{Operator{"+", [](float a, float b) { return a + b; }},
                           Operator{"-", [](float a, float b) { return a - b; }}};
constexpr std::array kProducts{Operator{"*", [](float a, float b) { return a * b; }},
                               Operator{"/", [](float a, float b) { return a / b; }}};

constexpr int kDeepest = 100;  // brackets within brackets
constexpr std::size_t kMostCharacters = 1000;
constexpr std::size_t kShownCharacters = 80;  // of a condition that is wrong

Tree node(Operation operation, Tree a, Tree b = nullptr) {
    return std::make_unique<ConditionNode const>(
        ConditionNode{.operation = operation, .a = std::move(a), .b = std::move(b)});
}

/// Recursive descent: a function for each precedence.
class Parser {
public:
    Parser(std::string_view text, std::vector<std::string> const& known, std::vector<std::string>& names)
        : text_(text), known_(known), names_(names) {}

    Tree condition() {
        if (text_.size() > kMostCharacters) {
            fail(fmt::format("an expression has at most {} characters, found {}", kMostCharacters, text_.size()));
        }
        Tree tree = disjunction();
        if (!at_end()) {
            fail("expected 'and', 'or', an operator or the end");
        }
        return tree;
    }

private:
    Tree disjunction() {
        return chain(kOr, [this] { return conjunction(); });
    }
    Tree conjunction() {
        return chain(kAnd, [this] { return negation(); });
    }
    Tree negation() {
        if (take("not")) {
            return node([](float a, float) { return truth(!is_true(a)); }, deeper([this] { return negation(); }));
        }
        return comparison();
    }
    Tree comparison() {
        Tree left = sum();
        if (Operator const* const found = take_one(kComparisons)) {
            Tree right = sum();
            return node(found->operation, std::move(left), std::move(right));
        }
        return left;
    }
    Tree sum() {
        return chain(kSums, [this] { return product(); });
    }
    Tree product() {
        return chain(kProducts, [this] { return factor(); });
    }
    Tree factor() {
        if (take("-")) {
            return node([](float a, float) { return -a; }, deeper([this] { return factor(); }));
        }
        if (take("(")) {
            return bracket();
        }
        if (std::size_t const before = at_; take("abs")) {
            if (take("(")) {
                return node([](float a, float) { return std::abs(a); }, bracket());
            }
            at_ = before;  // a value of that name
        }
        skip_blanks();
        if (at_ < text_.size() && (std::isdigit(letter()) != 0 || text_[at_] == '.')) {
            return number();
        }
        return value();
    }

    Tree bracket() {
        Tree inner = deeper([this] { return disjunction(); });
        if (!take(")")) {
            fail("expected ')'");
        }
        return inner;
    }

    Tree number() {
        std::string const digits(decimal_at_start(text_.substr(at_)));
        auto const found = static_cast<float>(number_from(digits));
        if (!std::isfinite(found)) {
            fail("expected a number");
        }
        at_ += digits.size();
        return std::make_unique<ConditionNode const>(ConditionNode{.number = found});
    }

    /// Names of columns may have any characters: the longest known name that stands here.
    Tree value() {
        std::string_view longest;
        for (std::string const& name : known_) {
            if (name.size() > longest.size() && stands_here(name)) {
                longest = name;
            }
        }
        if (longest.empty()) {
            std::size_t end = at_;
            while (end < text_.size() && is_of_word(text_[end])) {
                ++end;
            }
            std::string const word(text_.substr(at_, end - at_));
            fail(word.empty() ? "expected a value or a number"
                              : fmt::format("there is no value '{}': expected one of {}{}", word,
                                            fmt::join(known_, ", "), did_you_mean(word, known_)));
        }
        at_ += longest.size();
        auto const known = std::ranges::find(names_, longest);
        std::size_t const index = static_cast<std::size_t>(known - names_.begin());
        if (known == names_.end()) {
            names_.emplace_back(longest);
        }
        return std::make_unique<ConditionNode const>(ConditionNode{.value = index});
    }

    template <class Operators, class Part>
    Tree chain(Operators const& operators, Part const& part) {
        Tree left = part();
        while (Operator const* const found = take_one(operators)) {
            left = node(found->operation, std::move(left), part());
        }
        return left;
    }

    template <class Part>
    Tree deeper(Part const& part) {
        if (++depth_ > kDeepest) {
            fail("there are too many brackets");
        }
        Tree tree = part();
        --depth_;
        return tree;
    }

    template <class Operators>
    Operator const* take_one(Operators const& operators) {
        auto const found = std::ranges::find_if(operators, [this](Operator const& one) { return take(one.sign); });
        return found == operators.end() ? nullptr : &*found;
    }

    /// Goes on behind a sign or word if it stands here.
    bool take(std::string_view sign) {
        skip_blanks();
        if (!stands_here(sign)) {
            return false;
        }
        at_ += sign.size();
        return true;
    }

    /// A word must end where it does.
    bool stands_here(std::string_view sign) const {
        std::size_t const end = at_ + sign.size();
        bool const goes_on = is_of_word(sign.back()) && end < text_.size() && is_of_word(text_[end]);
        return text_.substr(at_).starts_with(sign) && !goes_on;
    }

    static bool is_of_word(char letter) {
        return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
    }

    int letter() const { return static_cast<unsigned char>(text_[at_]); }

    void skip_blanks() {
        while (at_ < text_.size() && std::isspace(letter()) != 0) {
            ++at_;
        }
    }

    bool at_end() {
        skip_blanks();
        return at_ == text_.size();
    }

    [[noreturn]] void fail(std::string const& what) const {
        std::size_t const first = at_ - std::min(at_, kShownCharacters / 2);
        throw ConfigError(fmt::format("'{}{}{}', character {}: {}", first > 0 ? "..." : "",
                                      text_.substr(first, kShownCharacters),
                                      first + kShownCharacters < text_.size() ? "..." : "", at_ + 1, what));
    }

    std::string_view text_;
    std::vector<std::string> const& known_;
    std::vector<std::string>& names_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

}  // namespace

Condition::Condition(std::string_view text, std::vector<std::string> const& known)
    : root_(Parser(text, known, names_).condition()) {}
Condition::~Condition() = default;
Condition::Condition(Condition&&) noexcept = default;
Condition& Condition::operator=(Condition&&) noexcept = default;

std::optional<std::size_t> Condition::first_robot(RobotValues const& values) {
    values_.resize(names_.size());
    places_.resize(names_.size());
    for (std::size_t i = 0; i < names_.size(); ++i) {
        values.read(names_[i], values_[i]);
        places_[i] = values_[i].data();
    }
    for (std::size_t robot = 0; robot < values.robot_count(); ++robot) {
        if (is_true(root_->evaluate(places_, robot))) {
            return robot;
        }
    }
    return std::nullopt;
}

void Condition::evaluate(std::span<float const* const> values, std::span<float> numbers) const {
    for (std::size_t robot = 0; robot < numbers.size(); ++robot) {
        numbers[robot] = root_->evaluate(values, robot);
    }
}

}  // namespace pogosim
