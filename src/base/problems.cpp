#include "base/problems.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace pogosim {

ConfigErrors::ConfigErrors(std::vector<std::string> messages)
    : ConfigError(fmt::format("{}", fmt::join(messages, "\n"))), messages_(std::move(messages)) {}

void Problems::add(std::string message, std::string const& path) {
    bool const is_known = !path.empty() && std::ranges::find(known_, path) != known_.end();
    if (is_known || std::ranges::find(messages_, message) != messages_.end()) {
        return;
    }
    messages_.push_back(std::move(message));
    paths_.push_back(path);
}

void Problems::leave_out_known_keys() {
    known_ = paths_;
}

void Problems::throw_if_any() const {
    if (messages_.size() == 1) {
        throw ConfigError(messages_.front());
    }
    if (!messages_.empty()) {
        throw ConfigErrors(messages_);
    }
}

}  // namespace pogosim
