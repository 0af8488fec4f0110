// The parameters of a user's program in its configuration, as the loader provides them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pogosim {

/// Where the values under `parameters` come from. Functions throw ConfigError for a value of the wrong type or range
/// and return no value for an absent one.
class ParameterSource {
public:
    virtual ~ParameterSource() = default;
    virtual std::optional<bool> boolean(std::string const& name) = 0;
    /// A number from -largest to largest, or .inf, -.inf or .nan.
    virtual std::optional<double> number(std::string const& name, double largest) = 0;
    /// Text of a fraction is truncated.
    virtual std::optional<std::int64_t> integer(std::string const& name, std::int64_t min, std::int64_t max) = 0;
    /// The first `most` bytes of a text, with a warning if there are more.
    virtual std::optional<std::string> text(std::string const& name, std::size_t most) = 0;
    /// The first `size` numbers of a list, with a warning if there are more; no value for an absent or empty list.
    virtual std::optional<std::vector<double>> numbers(std::string const& name, std::size_t size, double largest) = 0;
    /// Throws ConfigError: the value is not what the program expects.
    virtual void refuse(std::string const& name, std::string const& expected) = 0;
    /// Throws ConfigError unless `value`, which was read under this name, is from `min` to `max`.
    virtual void check_range(std::string const& name, double value, double min, double max) = 0;
};

}  // namespace pogosim
