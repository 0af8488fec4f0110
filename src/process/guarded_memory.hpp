// Zeroed memory between two protected pages: a program that writes beyond the end of its user data faults there and
// does not corrupt the simulator's own.
#pragma once

#include <cstddef>

namespace pogosim {

class GuardedMemory {
public:
    GuardedMemory() = default;

    /// The end of the block lies right before the forbidden page, as far as its alignment of 64 bytes allows. Throws
    /// std::bad_alloc.
    explicit GuardedMemory(std::size_t bytes);
    ~GuardedMemory();

    GuardedMemory(GuardedMemory const&) = delete;
    GuardedMemory& operator=(GuardedMemory const&) = delete;
    GuardedMemory(GuardedMemory&& other) noexcept;
    GuardedMemory& operator=(GuardedMemory&& other) noexcept;

    std::byte* data() const { return data_; }

private:
    void* mapping_ = nullptr;
    std::size_t mapped_bytes_ = 0;
    std::byte* data_ = nullptr;
};

}  // namespace pogosim
