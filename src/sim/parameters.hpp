// The values under `parameters` of a configuration, as user code asks for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/user_parameters.hpp"
#include "robot/context.hpp"

namespace pogosim {

class UserParameters final : public ParameterSource {
public:
    /// `parameters` outlives this.
    explicit UserParameters(Node const& parameters) : parameters_(parameters) {}

    std::optional<bool> boolean(std::string const& name) const override { return bool_parameter(parameters_, name); }
    std::optional<double> number(std::string const& name, double largest) const override {
        return number_parameter(parameters_, name, largest);
    }
    std::optional<std::int64_t> integer(std::string const& name, std::int64_t min, std::int64_t max) const override {
        return integer_parameter(parameters_, name, min, max);
    }
    std::optional<std::string> text(std::string const& name) const override {
        return text_parameter(parameters_, name);
    }
    std::optional<std::vector<double>> numbers(std::string const& name, std::size_t size,
                                               double largest) const override {
        return numbers_parameter(parameters_, name, size, largest);
    }

private:
    Node const& parameters_;
};

}  // namespace pogosim
