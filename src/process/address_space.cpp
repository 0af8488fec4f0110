#include "process/address_space.hpp"

#include <algorithm>
#include <span>

#include "process/loaded_modules.hpp"

namespace pogosim {

namespace {

constexpr std::uint64_t kAddressElsewhere = 0xADD2E55;  // any number

// Where the system puts programs, their heaps, libraries, stacks and what a sanitizer allocates. A word in these ranges
// counts as an address, whether or not this run has mapped anything there: otherwise the same number would be an
// address in some runs and a number in others.
#if defined(__APPLE__)
constexpr std::uint64_t kFirstAddress = 0x100000000;
constexpr std::uint64_t kEndOfAddresses = 0x800000000000;
#elif defined(__aarch64__)
constexpr std::uint64_t kFirstAddress = 0xaaaa00000000;
constexpr std::uint64_t kEndOfAddresses = 0x1000000000000;
#else
constexpr std::uint64_t kFirstAddress = 0x550000000000;
constexpr std::uint64_t kEndOfAddresses = 0x800000000000;
#endif

}  // namespace

AddressSpace::AddressSpace(ProgramImage const& image)
    : program_{.begin = image.load_address, .end = image.load_address} {
    // An image is one piece of the address space; its last byte may be one past the end of its last variable.
    for (std::span<std::byte> const piece : image.variables) {
        program_.end = std::max(program_.end, reinterpret_cast<std::uint64_t>(piece.data() + piece.size()));
    }
    // The heap of a process without random addresses (-no-pie) begins behind its executable. It may be in pieces,
    // because madvise() splits a mapping.
    for (MappedMemory const& piece : mapped_memory()) {
        if (piece.is_heap) {
            heap_ = {.begin = heap_.end == 0 ? piece.begin : heap_.begin, .end = piece.end};
        }
    }
}

std::uint64_t AddressSpace::without_place(std::uint64_t word) const {
    if (program_.contains(word)) {
        return word - program_.begin;
    }
    bool const is_address = (word >= kFirstAddress && word < kEndOfAddresses) || heap_.contains(word);
    return is_address ? kAddressElsewhere : word;
}

}  // namespace pogosim
