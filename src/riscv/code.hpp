// The program of a firmware, decoded once for all robots that run it, with the cycles that each instruction takes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "riscv/cycle_costs.hpp"
#include "riscv/instruction.hpp"

namespace pogosim {

/// An instruction, ready to be executed at its address.
///
/// Differs from Instruction in what is known before it runs: auipc has become lui; branches and jal count by how many
/// steps they go on instead of bytes; a result that nothing reads goes to kUnread instead of x0.
struct Step {
    Operation operation = Operation::illegal;
    std::uint8_t rd = 0;  // of branch_outside: the operation of the branch
    std::uint8_t rs1 = 0;
    std::uint8_t rs2 = 0;
    std::int32_t immediate = 0;       // of jump_outside and branch_outside: the address that is jumped to; of
                                      // intercepted: its number
    std::int32_t other_cycles = 0;    // see Code
    std::uint32_t cycles_to_end = 0;  // see Code
};

inline constexpr std::uint8_t kUnread = 32;  // a register after x31, in the place of x0 as a destination

/// Read-only while robots run it, on any number of threads. Robots cannot change their code.
///
/// Cycles are not counted instruction by instruction. cycles_before is the sum of what all instructions in front of a
/// step take at least: branches that are not taken, shifts by one bit. So straight code costs a subtraction.
/// Corrections are needed only for what leaves this order, or takes longer:
///
///     other_cycles    of a branch or jal: what is added to (cycles that have passed) - (cycles_before of the step)
///                     when it is taken; of jalr: the cycles it takes; of a shift by a register: the cycles of a
///                     further bit
///     cycles_to_end   cycles_before of the next step, from this one on, that may jump or take further cycles: jal,
///                     jalr, a shift by a register, or a stop; with a cache miss for each line up to there. A core with
///                     more cycles left need not look at its budget until then, or until it takes a branch.
struct Code {
    std::uint32_t address = 0;                 // of the first instruction; a multiple of 4
    std::vector<Step> steps;                   // one for each word, then one that stops at the end
    std::vector<std::uint32_t> cycles_before;  // of each step
    std::uint32_t cache_miss = 0;              // cycles

    std::uint32_t bytes() const { return static_cast<std::uint32_t>(4 * (steps.size() - 1)); }

    /// Whether any of some bytes in memory are of the code.
    bool overlaps(std::uint32_t begin, std::uint64_t size) const {
        return size > 0 && begin < std::uint64_t{address} + bytes() && address < begin + size;
    }

    /// The step of the instruction at a place in memory. Null if none is there.
    Step const* step_at(std::uint32_t place) const {
        std::uint32_t const offset = place - address;
        return offset % 4 == 0 && offset < bytes() ? &steps[offset / 4] : nullptr;
    }
};

/// Decodes the words at an address. Words that are no instruction, such as constants between functions, stop a robot
/// only if it gets there. A part of a word at the end is left out.
Code decode_code(std::uint32_t address, std::span<std::byte const> bytes, CycleCosts const& costs = {});

/// Makes robots stop before the instruction at an address, each time. intercepted_number() of that address is `number`
/// then. False if no instruction is there.
bool intercept(Code& code, std::uint32_t address, std::int32_t number = 0);

/// The number of an address that is intercepted.
std::int32_t intercepted_number(Code const& code, std::uint32_t address);

}  // namespace pogosim
