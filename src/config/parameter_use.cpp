#include "config/parameter_use.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/nearest_name.hpp"
#include "config/values.hpp"

namespace pogosim {

Node const* ParameterUse::ask(std::string const& name) {
    Node const* const node = find_path(parameters_, name);
    if (node == nullptr) {
        if (std::ranges::find(missed_, name) == missed_.end()) {
            missed_.push_back(name);
        }
        return nullptr;
    }
    return read_.insert(node).second ? node : nullptr;
}

std::string ParameterUse::unread() const {
    std::vector<std::string> unread;
    collect(parameters_, "", unread);
    return fmt::format("{}", fmt::join(unread, ", "));
}

bool ParameterUse::any_part_was_read(Node const& node) const {
    auto const is_read = [this](Node const& part) { return any_part_was_read(part); };
    return was_read(node) || std::ranges::any_of(node.items, is_read) ||
           std::ranges::any_of(node.entries, [&](auto const& entry) { return is_read(entry.value); });
}

void ParameterUse::collect(Node const& node, std::string const& path, std::vector<std::string>& unread) const {
    bool const is_list = !node.items.empty();  // read as a whole
    if (was_read(node) || (is_list && any_part_was_read(node))) {
        return;
    }
    for (auto const& [key, value] : node.entries) {
        collect(value, path.empty() ? key : fmt::format("{}.{}", path, key), unread);
    }
    if (node.entries.empty() && &node != &parameters_) {
        unread.push_back(fmt::format("{} ({}{})", shown(path), node.where(), did_you_mean(shown(path), missed_)));
    }
}

}  // namespace pogosim
