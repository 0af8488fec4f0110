// How many clock cycles instructions take on the robots' processor.
//
// The robot has a VexRiscv "Lite" at 21 MHz: five stages with all bypasses, an instruction cache of 2 KiB, no data
// cache, static branch prediction, an iterative shifter, multiplier and divider, branches decided in the fourth stage
// (memory).
//
// Sources: the configuration of "Lite" is the line of VexRiscv_Lite.v in the Makefile of
// litex-hub/pythondata-cpu-vexriscv; cycles are from the section "Plugins" of SpinalHDL/VexRiscv's README. What is
// marked as an estimate is ours, from the pipeline as the README describes it, and has not been measured on a robot.
// What a robot reads from its flash takes no longer than what it reads from its memory.
#pragma once

namespace pogosim {

/// Cycles, at least 1 each but for shift_further_bit and cache_miss. "1 +" is the cycle that each instruction takes in
/// a full pipeline.
struct CycleCosts {
    int alu = 1;                // addition, comparison, logic, lui, auipc, fence
    int shift = 1;              // by 0 bits or 1
    int shift_further_bit = 1;  // LightShifterPlugin: one cycle for each bit; may be 0
    int load = 3;               // estimate: 1 + 1 for the Wishbone bus + 1 until the loaded value can be used
    int store = 2;              // estimate: 1 + 1 for the Wishbone bus
    int multiply = 33;          // MulDivIterativePlugin: 1 + 32
    int divide = 34;            // MulDivIterativePlugin: 1 + 33
    int jump = 2;               // jal, BranchPlugin: 1 + 1, as of a branch that is predicted as taken
    int jump_register = 4;      // jalr, not predicted: 1 + 3, an estimate (README: 2 to 4, by the configuration)

    // Branches backwards are predicted as taken, others as not taken.
    int branch_predicted_taken = 2;      // BranchPlugin: 1 + 1
    int branch_predicted_not_taken = 1;  // BranchPlugin: 1
    int branch_mispredicted = 4;         // 1 + 3, an estimate, as jalr

    // Estimate: 8 words at 2 cycles each on the Wishbone bus, and 2 to begin. May be 0: all code is in the cache.
    int cache_miss = 18;  // fetching a line of code into the instruction cache, see instruction_cache.hpp

    friend bool operator==(CycleCosts const&, CycleCosts const&) = default;
};

}  // namespace pogosim
