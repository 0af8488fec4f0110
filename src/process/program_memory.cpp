#include "process/program_memory.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <new>
#include <utility>

namespace pogosim {

namespace {

constexpr std::size_t kAlignment = 64;

std::size_t round_up(std::size_t bytes, std::size_t unit) {
    return (bytes + unit - 1) / unit * unit;
}

}  // namespace

GuardedMemory::GuardedMemory(std::size_t bytes) {
    auto const page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    std::size_t const usable = round_up(bytes, page);
    mapped_bytes_ = usable + 2 * page;
    mapping_ = mmap(nullptr, mapped_bytes_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapping_ == MAP_FAILED) {
        mapping_ = nullptr;
        throw std::bad_alloc();
    }
    std::byte* const first = static_cast<std::byte*>(mapping_) + page;
    if (mprotect(first, usable, PROT_READ | PROT_WRITE) != 0) {
        munmap(mapping_, mapped_bytes_);
        throw std::bad_alloc();
    }
    data_ = first + (usable - round_up(bytes, kAlignment));
}

GuardedMemory::~GuardedMemory() {
    if (mapping_ != nullptr) {
        munmap(mapping_, mapped_bytes_);
    }
}

GuardedMemory::GuardedMemory(GuardedMemory&& other) noexcept
    : mapping_(std::exchange(other.mapping_, nullptr)),
      mapped_bytes_(std::exchange(other.mapped_bytes_, 0)),
      data_(std::exchange(other.data_, nullptr)) {}

GuardedMemory& GuardedMemory::operator=(GuardedMemory&& other) noexcept {
    std::swap(mapping_, other.mapping_);
    std::swap(mapped_bytes_, other.mapped_bytes_);
    std::swap(data_, other.data_);
    return *this;
}

POGOSIM_SEES_ALL_BYTES void copy_program_bytes(std::byte* to, std::byte const* from, std::size_t count) {
    auto volatile* const target = to;  // else compilers call memcpy(), which a sanitizer replaces with its own
    for (std::size_t i = 0; i < count; ++i) {
        target[i] = from[i];
    }
}

}  // namespace pogosim
