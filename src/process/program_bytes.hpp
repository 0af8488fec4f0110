// Copies of a program's variables, with the bytes between them.
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

/// Bytes of a program's variables, and those that a sanitizer forbids between them.
void copy_program_bytes(std::byte* to, std::byte const* from, std::size_t count);

}  // namespace pogosim
