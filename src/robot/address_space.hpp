// What a word of memory says beyond the place where the system has put things in this run.
#pragma once

#include <cstdint>

#include "robot/program_image.hpp"

namespace pogosim {

class AddressSpace {
public:
    /// As it is now.
    explicit AddressSpace(ProgramImage const& image);

    /// The same in every run: of an address in the program its offset there, of another one a constant, and what is no
    /// address as it is. Numbers that look like an address count as one.
    std::uint64_t without_place(std::uint64_t word) const;

private:
    struct Range {
        std::uint64_t begin = 0;
        std::uint64_t end = 0;
        bool contains(std::uint64_t word) const { return word >= begin && word < end; }
    };
    Range program_;
    Range heap_{};
};

}  // namespace pogosim
