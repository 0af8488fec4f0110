// What a word of memory says beyond the place where the system has put things in this run.
#pragma once

#include <cstdint>
#include <vector>

#include "robot/program_image.hpp"

namespace pogosim {

class AddressSpace {
public:
    /// As it is now.
    explicit AddressSpace(ProgramImage const& image);

    /// The same in every run: of an address in the program its offset there, of another one a constant, and what is no
    /// address as it is.
    std::uint64_t without_place(std::uint64_t word) const;

private:
    struct Mapping {
        std::uint64_t begin;
        std::uint64_t end;
        bool is_programs;
    };
    std::uint64_t load_address_;
    std::vector<Mapping> mappings_;  // ascending
};

}  // namespace pogosim
