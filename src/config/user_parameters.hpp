// The values under `parameters` for the global variables of a user's program, and which of them it has asked for. Names
// are dotted paths as in find_path. Each question has no answer for a value that is absent or null, and throws
// ConfigError ("file:line: parameters.x: expected ..., found ...") for one of another type or out of range.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "config/range.hpp"
#include "config/scenario.hpp"
#include "config/tree.hpp"
#include "world/parameter_source.hpp"

namespace pogosim {

class UserParameters final : public ParameterSource {
public:
    explicit UserParameters(Scenario const& scenario);
    explicit UserParameters(Node parameters) : parameters_(std::move(parameters)) {}
    UserParameters(UserParameters const&) = delete;
    UserParameters& operator=(UserParameters const&) = delete;

    /// The same values but one, which is YAML; nothing has been asked.
    UserParameters with(std::string const& name, std::string const& yaml_value) const;

    std::optional<bool> boolean(std::string const& name) override;
    std::optional<double> number(std::string const& name, double largest) override;
    std::optional<std::int64_t> integer(std::string const& name, std::int64_t min, std::int64_t max) override;
    std::optional<std::string> text(std::string const& name, std::size_t most) override;
    std::optional<std::vector<double>> numbers(std::string const& name, std::size_t size, double largest) override;
    void refuse(std::string const& name, std::string const& expected) override;
    void check_range(std::string const& name, double value, double min, double max) override;

    /// The values that the program has not read: "walk.sped (conf/a.yaml:14; did you mean 'walk.speed'?), ...". Empty
    /// when there are none. Each value of a map counts; a list counts as read if any item was.
    std::string unread() const;

private:
    /// Notes that the program wants this value. Nullptr for one that is absent or null.
    Node const* ask(std::string const& name);
    template <class T>
    std::optional<T> read(std::string const& name, Range const& range);

    struct Unread {
        std::string path;
        Node const* node;
    };

    bool any_part_was_read(Node const& node) const;
    void collect_unread(Node const& node, std::string const& path, std::vector<Unread>& unread) const;

    Node parameters_;
    std::unordered_set<Node const*> read_;
    std::vector<std::string> missed_;  // asked for, but not there
};

}  // namespace pogosim
