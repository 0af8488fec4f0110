// Makes words of memory comparable between runs, which have different addresses.
#pragma once

#include <cstdint>

#include "process/program_image.hpp"

namespace pogosim {

class AddressSpace {
public:
    /// Reads the present address space of the process.
    explicit AddressSpace(ProgramImage const& image);

    /// The word in a form that is the same in every run: the offset of an address in the program, a constant for any
    /// other address, and a number as it is. Numbers that look like addresses count as addresses.
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
