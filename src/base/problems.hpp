// Mistakes of a user that are collected, so that all of them are reported at once.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"

namespace pogosim {

/// A mistake in the value of one key: "objects.robots.nb".
class KeyError : public ConfigError {
public:
    KeyError(std::string path, std::string const& message) : ConfigError(message), path_(std::move(path)) {}
    std::string const& path() const { return path_; }

private:
    std::string path_;
};

/// Several mistakes; what() has one per line.
class ConfigErrors : public ConfigError {
public:
    explicit ConfigErrors(std::vector<std::string> messages);
    std::vector<std::string> const& messages() const { return messages_; }

private:
    std::vector<std::string> messages_;
};

class Problems {
public:
    /// Does a part of the work, and keeps the ConfigError that ends it. True if there was none.
    template <class Part>
    bool collect(Part const& part) {
        try {
            part();
            return true;
        } catch (KeyError const& error) {
            add(error.what(), error.path());
        } catch (ConfigErrors const& errors) {
            for (std::string const& message : errors.messages()) {
                add(message);
            }
        } catch (ConfigError const& error) {
            add(error.what());
        }
        return false;
    }

    /// `path`: of the key that is wrong; may be empty.
    void add(std::string message, std::string const& path = {});

    /// From now on, another mistake in a key that is already known to be wrong is left out, since it follows from the
    /// first one.
    void leave_out_known_keys();

    bool empty() const { return messages_.empty(); }
    std::vector<std::string> const& messages() const { return messages_; }

    /// Keys that are wrong; empty for a mistake that has none.
    std::vector<std::string> const& paths() const { return paths_; }

    /// Whether something about this key is wrong.
    bool has_key(std::string const& path) const { return std::ranges::find(paths_, path) != paths_.end(); }

    /// Throws ConfigError for one mistake, and ConfigErrors for several.
    void throw_if_any() const;

private:
    std::vector<std::string> messages_;
    std::vector<std::string> paths_;  // of wrong keys
    std::vector<std::string> known_;
};

}  // namespace pogosim
