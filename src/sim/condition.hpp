// A condition on the values of robots, such as "speed < 1 and heard > 10", for breakpoints; and an expression of them,
// such as "light / 1000", for rewards of hosts.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/robot_values.hpp"

namespace pogosim {

struct ConditionNode;

class Condition {
public:
    /// `known`: names of values. Operators, lowest precedence first: or; and; not; < <= > >= == != (one of them); + -;
    /// * /; unary minus. Operands: numbers, names, abs(x), brackets. Throws ConfigError, which says where the text is
    /// wrong.
    Condition(std::string_view text, std::vector<std::string> const& known);
    ~Condition();
    Condition(Condition&&) noexcept;
    Condition& operator=(Condition&&) noexcept;

    /// The first robot of which it is true. A comparison with a value that is not there is false.
    std::optional<std::size_t> first_robot(RobotValues const& values);

    /// What it is for each of some robots; truth values are 1 and 0. `values`: those of names(), in this order, with a
    /// number for each robot, NaN where there is none.
    void evaluate(std::span<float const* const> values, std::span<float> numbers) const;

    /// The names in it, each once.
    std::vector<std::string> const& names() const { return names_; }

private:
    std::vector<std::string> names_;
    std::vector<std::vector<float>> values_;  // by name, then by robot: memory that each step uses again
    std::vector<float const*> places_;        // of these
    std::unique_ptr<ConditionNode const> root_;
};

}  // namespace pogosim
