// The values under `parameters` for the global variables of a user's program, and which of them it has asked for. Names
// are dotted paths as in find_path. Each question has no answer for a value that is absent or null. A value out of
// range is a ConfigError ("file:line: parameters.x: expected ..., found ..."), one of another type may be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/problems.hpp"
#include "config/range.hpp"
#include "config/scenario.hpp"
#include "config/tree.hpp"
#include "config/values.hpp"
#include "world/parameter_source.hpp"

namespace pogosim {

/// Which values are mistakes.
enum class Conversions {
    lenient,  // one of another type than the program asks for is a warning: it may be meant for another program
    typed,    // it is refused
    exact,    // so is a fraction where the program asks for an integer
};

/// Values that the program has not read.
struct UnreadParameters {
    std::string all;    // "walk.sped (conf/a.yaml:14; did you mean 'walk.speed'?), ..."; empty: there are none
    std::string brief;  // those of --set, those near to a name that the program has asked for, and how many others
};

class UserParameters final : public ParameterSource {
public:
    UserParameters(Scenario const& scenario, Conversions conversions);
    explicit UserParameters(Node parameters, Conversions conversions = Conversions::typed)
        : parameters_(std::move(parameters)), conversions_(conversions) {}
    UserParameters(UserParameters const&) = delete;
    UserParameters& operator=(UserParameters const&) = delete;

    /// The same values but one, which is YAML; nothing has been asked. Values of another type are refused.
    UserParameters with(std::string const& name, std::string const& yaml_value) const;

    std::optional<bool> boolean(std::string const& name) override;
    std::optional<double> number(std::string const& name, double largest) override;
    std::optional<std::int64_t> integer(std::string const& name, std::int64_t min, std::int64_t max) override;
    std::optional<std::string> text(std::string const& name, std::size_t most) override;
    std::optional<std::vector<double>> numbers(std::string const& name, std::size_t size, double largest) override;
    void refuse(std::string const& name, std::string const& expected) override;
    void check_range(std::string const& name, double value, double min, double max) override;

    /// From now on, mistakes are added to `problems` instead of thrown, and the value has no answer; but for those that
    /// the program itself finds, after which it cannot go on. `problems` outlives this.
    void collect_in(Problems& problems) { problems_ = &problems; }

    /// Whether the program itself has refused a value.
    bool has_refused() const { return has_refused_; }

    /// The values that the program has not read. Each value of a map counts; a list counts as read if any item was.
    UnreadParameters unread() const;

private:
    /// Notes that the program wants this value. Nullptr for one that is absent or null.
    Node const* ask(std::string const& name);
    template <class T>
    std::optional<T> read(std::string const& name, Range const& range);
    /// The value that convert() makes of the node under this name; nothing where there is none, or where a mistake in
    /// it does not end the run.
    template <class T>
    std::optional<T> converted(std::string const& name, std::function<T(Place const&)> const& convert);

    struct Unread {
        std::string path;
        Node const* node;
    };

    /// "; did you mean 'x'?" of one that --set names, which is meant for this program; or an empty string.
    std::string hint_of_set(std::string const& path) const;
    bool any_part_was_read(Node const& node) const;
    void collect_unread(Node const& node, std::string const& path, std::vector<Unread>& unread) const;

    Node parameters_;
    Conversions conversions_ = Conversions::typed;
    Problems* problems_ = nullptr;
    bool has_refused_ = false;
    std::unordered_set<Node const*> read_;
    std::unordered_set<Node const*> of_other_programs_;  // of another type than asked for, which has been said
    std::vector<std::string> found_;                     // asked for, each once
    std::vector<std::string> missed_;                    // asked for, but not there
};

}  // namespace pogosim
