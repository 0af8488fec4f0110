// What a world was made from besides its configuration, as the files were when they were read: they may change later.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/fnv_1a.hpp"

namespace pogosim {

/// While this exists, what this thread notes is hashed.
class InputHash {
public:
    /// `value`: of what was read before.
    explicit InputHash(std::uint64_t value = kFnvBasis) : before_(of_thread_), value_(value) { of_thread_ = this; }
    ~InputHash() { of_thread_ = before_; }
    InputHash(InputHash const&) = delete;
    InputHash& operator=(InputHash const&) = delete;

    std::uint64_t value() const { return value_; }

    /// The content of a file that was read.
    static void note(std::string_view content) {
        if (of_thread_ != nullptr) {
            of_thread_->value_ = fnv_1a(content, of_thread_->value_);
        }
    }

private:
    static inline constinit thread_local InputHash* of_thread_ = nullptr;

    InputHash* before_;
    std::uint64_t value_;
};

}  // namespace pogosim
