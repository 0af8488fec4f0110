#include "robot/address_space.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

namespace pogosim {

namespace {

constexpr std::uint64_t kAddressElsewhere = 0xADD2E55;  // any number

}  // namespace

AddressSpace::AddressSpace(ProgramImage const& image) : load_address_(image.load_address) {
    // An image is one piece of the address space; its last byte may be one past the end of its last variable.
    std::uint64_t image_end = image.load_address;
    for (std::span<std::byte> const piece : image.variables) {
        image_end = std::max(image_end, reinterpret_cast<std::uint64_t>(piece.data() + piece.size()));
    }
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        std::uint64_t begin = 0;
        std::uint64_t end = 0;
        if (std::sscanf(line.c_str(), "%" SCNx64 "-%" SCNx64, &begin, &end) == 2) {
            bool const is_programs = begin >= image.load_address && begin < image_end;
            mappings_.push_back({.begin = begin, .end = end, .is_programs = is_programs});
        }
    }
}

std::uint64_t AddressSpace::without_place(std::uint64_t word) const {
    auto const next = std::ranges::upper_bound(mappings_, word, {}, &Mapping::begin);
    if (next == mappings_.begin() || word >= std::prev(next)->end) {
        return word;
    }
    return std::prev(next)->is_programs ? word - load_address_ : kAddressElsewhere;
}

}  // namespace pogosim
