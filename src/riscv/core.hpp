// A robot's processor core: its registers, and running a program on them.
//
// Each robot has a Core and a Memory of its own; the Code of a firmware is shared. What happens depends on nothing
// else, so robots may run on several threads, and a run may be divided into any pieces.
#pragma once

#include <array>
#include <cstdint>

#include "riscv/code.hpp"
#include "riscv/instruction_cache.hpp"
#include "riscv/memory_image.hpp"

namespace pogosim {

struct Core {
    std::array<std::uint32_t, 32> x{};  // x[0] is 0 to programs, whatever is written here
    std::uint32_t pc = 0;               // address of the next instruction
    std::uint64_t cycles = 0;           // that have passed since the core began
    InstructionCache cache{};

    bool operator==(Core const&) const = default;
};

enum class StopReason : std::uint8_t {
    budget_used,
    intercepted,
    // The instruction at pc cannot be executed.
    illegal_instruction,
    unaligned_access,
    outside_access,    // no memory is there
    store_into_flash,  // which is read-only
    store_into_code,   // which has been decoded already
    jump_outside,      // a jump to where there is no code or, at pc, no code at all
    ecall,
    ebreak,
    wait_for_interrupt,  // wfi: there are no interrupts, so the program is over
};

/// Why, and where, a core stopped.
struct Stop {
    StopReason reason = StopReason::budget_used;
    std::uint32_t pc = 0;       // as in the core
    std::uint32_t address = 0;  // that was accessed, or jumped to; else 0

    bool operator==(Stop const&) const = default;
};

/// Runs until most_cycles have passed, an intercepted address is reached or an instruction cannot be executed.
///
/// An instruction begins if a cycle is left, and is then finished: the last one may take more than most_cycles. The
/// instruction at pc, where it stops, has had no effect and has taken no cycle: a caller may do its work, and go on at
/// another pc.
///
/// The only control and status registers are the counter of cycles (cycle, mcycle, and their upper halves). All others
/// read as 0, and what is written to them is lost: there are no interrupts that they could set up.
Stop run(Core& core, Memory& memory, Code const& code, std::uint64_t most_cycles);

}  // namespace pogosim
