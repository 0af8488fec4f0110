// Memory of programs: blocks that robots cannot write beyond, and copies of variables.
#pragma once

#include <cstddef>

// A program built with -fsanitize=address has forbidden bytes between its variables, which are copied with the rest.
#if defined(__SANITIZE_ADDRESS__)
#define POGOSIM_SEES_ALL_BYTES __attribute__((no_sanitize("address"), noinline))
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define POGOSIM_SEES_ALL_BYTES __attribute__((no_sanitize("address"), noinline))
#endif
#endif
#ifndef POGOSIM_SEES_ALL_BYTES
#define POGOSIM_SEES_ALL_BYTES
#endif

namespace pogosim {

/// Zeroed memory between two protected pages: a program that writes beyond the end of its user data faults there and
/// does not corrupt the simulator's own.
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

/// Copies bytes of a program's variables, and those that a sanitizer forbids between them.
void copy_program_bytes(std::byte* to, std::byte const* from, std::size_t count);

}  // namespace pogosim
