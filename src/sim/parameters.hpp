// The values under `parameters` of a configuration, read by user code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/parameter_use.hpp"
#include "config/user_parameters.hpp"
#include "config/values.hpp"
#include "robot/context.hpp"

namespace pogosim {

class UserParameters final : public ParameterSource {
public:
    /// `parameters` outlives this.
    explicit UserParameters(Node const& parameters) : parameters_(parameters), use_(parameters) {}

    std::optional<bool> boolean(std::string const& name) override {
        use_.ask(name);
        return bool_parameter(parameters_, name);
    }
    std::optional<double> number(std::string const& name, double largest) override {
        use_.ask(name);
        return number_parameter(parameters_, name, largest);
    }
    std::optional<std::int64_t> integer(std::string const& name, std::int64_t min, std::int64_t max) override {
        Node const* const first_read = use_.ask(name);
        auto const value = integer_parameter(parameters_, name, min, max);
        if (first_read != nullptr) {
            warn_of_slips({*first_read, "parameters." + name}, {}, /*is_integer=*/true);
        }
        return value;
    }
    std::optional<std::string> text(std::string const& name) override {
        use_.ask(name);
        return text_parameter(parameters_, name);
    }
    std::optional<std::vector<double>> numbers(std::string const& name, std::size_t size, double largest) override {
        use_.ask(name);
        return numbers_parameter(parameters_, name, size, largest);
    }

    void refuse(std::string const& name, std::string const& expected) override {
        refuse_parameter(parameters_, name, expected);
    }
    void check_range(std::string const& name, double value, double min, double max) override {
        check_parameter_range(parameters_, name, value, between(min, max));
    }

    /// The values that the program never read, with file and line; empty if there are none.
    std::string unread() const { return use_.unread(); }

private:
    Node const& parameters_;
    ParameterUse use_;
};

}  // namespace pogosim
