// Parts of a file of a program, which may end before they do.
#pragma once

#include <cstddef>
#include <span>

namespace pogosim {

/// `count` structures that begin at `offset`; null if the file has no room for them.
template <class T>
T const* elf_at(std::span<char const> bytes, std::size_t offset, std::size_t count = 1) {
    bool const inside = offset <= bytes.size() && count <= (bytes.size() - offset) / sizeof(T);
    return inside ? reinterpret_cast<T const*>(bytes.data() + offset) : nullptr;
}

}  // namespace pogosim
