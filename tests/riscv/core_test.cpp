#include "riscv/core.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "riscv/robot.hpp"

namespace {

using namespace pogosim;
using namespace pogosim::testing;
using enum Operation;

/// x5 counts down from a number; the words of the body come before it.
std::vector<std::uint32_t> loop(std::int32_t times, std::vector<std::uint32_t> const& body) {
    std::vector<std::uint32_t> words{encode(addi, {.rd = 5, .immediate = times})};
    words.insert(words.end(), body.begin(), body.end());
    words.push_back(encode(addi, {.rd = 5, .rs1 = 5, .immediate = -1}));
    words.push_back(encode(bne, {.rs1 = 5, .immediate = -4 * static_cast<std::int32_t>(body.size() + 1)}));
    words.push_back(encode(ecall));
    return words;
}

/// A loop with everything that takes other cycles.
std::vector<std::uint32_t> long_loop(std::int32_t times) {
    return loop(times, {
                           encode(mul, {.rd = 6, .rs1 = 5, .rs2 = 5}),
                           encode(andi, {.rd = 7, .rs1 = 5, .immediate = 15}),
                           encode(sll, {.rd = 8, .rs1 = 6, .rs2 = 7}),
                           encode(srai, {.rd = 8, .rs1 = 8, .immediate = 9}),
                           encode(sw, {.rs2 = 8, .immediate = 1024}),
                           encode(beq, {.rs1 = 7, .immediate = 8}),
                           encode(lw, {.rd = 9, .immediate = 1024}),
                           encode(jal, {.rd = 1, .immediate = 8}),
                           encode(ebreak),
                           encode(divu, {.rd = 9, .rs1 = 9, .rs2 = 5}),
                           encode(add, {.rd = 10, .rs1 = 10, .rs2 = 9}),
                       });
}

TEST(RiscvCycles, LoopTakesWhatItsInstructionsDo) {
    CycleCosts const costs;
    for (std::uint32_t const n : {1U, 2U, 10U, 2000U}) {
        Robot robot(loop(static_cast<std::int32_t>(n), {}));
        EXPECT_EQ(robot.run().reason, StopReason::ecall);
        // All branches but the last go back, as predicted.
        EXPECT_EQ(robot.core.cycles, costs.cache_miss + costs.alu + n * costs.alu +
                                         (n - 1) * costs.branch_predicted_taken + costs.branch_mispredicted);
    }
}

TEST(RiscvCycles, EachKindOfInstructionHasItsCost) {
    CycleCosts const costs{.alu = 2,
                           .shift = 3,
                           .shift_further_bit = 5,
                           .load = 7,
                           .store = 11,
                           .multiply = 13,
                           .divide = 17,
                           .cache_miss = 0};
    constexpr std::uint32_t kTimes = 100;
    auto const cycles_of = [&](std::vector<std::uint32_t> const& body) {
        Robot robot(loop(kTimes, body), costs);
        robot.core.x[6] = 9;
        EXPECT_EQ(robot.run().reason, StopReason::ecall);
        return robot.core.cycles;
    };
    std::uint64_t const empty = cycles_of({});
    auto const cost_of = [&](Operation operation, Fields const& fields = {}) {
        return (cycles_of({encode(operation, fields)}) - empty) / kTimes;
    };
    EXPECT_EQ(cost_of(lui), 2U);
    EXPECT_EQ(cost_of(fence), 2U);
    EXPECT_EQ(cost_of(slli, {.immediate = 0}), 3U);
    EXPECT_EQ(cost_of(slli, {.immediate = 1}), 3U);
    EXPECT_EQ(cost_of(srai, {.immediate = 31}), 3U + 30 * 5);
    EXPECT_EQ(cost_of(sra, {.rs2 = 0}), 3U);
    EXPECT_EQ(cost_of(srl, {.rs2 = 6}), 3U + 8 * 5);
    EXPECT_EQ(cost_of(lhu), 7U);
    EXPECT_EQ(cost_of(sb, {.immediate = 1024}), 11U);
    EXPECT_EQ(cost_of(mulhsu), 13U);
    EXPECT_EQ(cost_of(remu), 17U);
    EXPECT_EQ(cost_of(jal, {.immediate = 4}), costs.jump);
    EXPECT_EQ(cost_of(beq, {.immediate = 4}), costs.branch_mispredicted);
    EXPECT_EQ(cost_of(bne, {.immediate = 8}), costs.branch_predicted_not_taken);
    EXPECT_EQ(cost_of(bne, {.immediate = -4}), costs.branch_mispredicted);
    // jal to the word after the next, which is jumped over; back by a register.
    EXPECT_EQ(
        (cycles_of({encode(jal, {.rd = 1, .immediate = 8}), encode(jal, {.immediate = 8}), encode(jalr, {.rs1 = 1})}) -
         empty) /
            kTimes,
        2U * costs.jump + costs.jump_register);
}

TEST(RiscvCycles, AnyPiecesOfARunAreTheRun) {
    Robot whole(long_loop(300));
    EXPECT_EQ(whole.run().reason, StopReason::ecall);
    for (std::uint64_t const piece : {1, 2, 3, 7, 40, 100, 1000}) {
        Robot robot(long_loop(300));
        while (robot.run(piece).reason == StopReason::budget_used) {
        }
        EXPECT_EQ(robot.core, whole.core);
    }
}

TEST(RiscvCycles, NoInstructionBeginsAfterTheBudget) {
    std::vector<Core> states;  // before each instruction
    Robot single(long_loop(20));
    do {
        states.push_back(single.core);
    } while (single.run(1).reason == StopReason::budget_used);
    for (std::uint64_t budget = 0; budget <= states.back().cycles; ++budget) {
        Robot robot(long_loop(20));
        Stop const stop = robot.run(budget);
        auto const expected = std::ranges::find_if(states, [&](Core const& state) { return state.cycles >= budget; });
        ASSERT_EQ(robot.core, *expected) << budget;
        ASSERT_EQ(stop, (Stop{StopReason::budget_used, expected->pc, 0}));
    }
    Robot robot(long_loop(20));
    EXPECT_EQ(robot.run(states.back().cycles + 1).reason, StopReason::ecall);
}

TEST(RiscvCore, RegisterZeroStaysZero) {
    Robot robot({encode(addi, {.immediate = 5}), encode(lui, {.immediate = 4096}), encode(lw, {}),
                 encode(mul, {.rs1 = 5, .rs2 = 5}), encode(jal, {.immediate = 4}), encode(add, {.rd = 6}),
                 encode(ecall)});
    robot.core.x[0] = 99;
    robot.core.x[5] = 3;
    EXPECT_EQ(robot.run().reason, StopReason::ecall);
    EXPECT_EQ(robot.core.x[0], 0U);
    EXPECT_EQ(robot.core.x[6], 0U);
}

TEST(RiscvCore, StopSaysWhyAndWhere) {
    struct Case {
        std::uint32_t word;
        StopReason reason;
        std::uint32_t address;
    };
    constexpr std::uint32_t kFlash = kFlashAddress;  // in x5; x6 is 0xfffffffc
    for (Case const& expected : {
             Case{encode(ecall), StopReason::ecall, 0},
             Case{encode(ebreak), StopReason::ebreak, 0},
             Case{0, StopReason::illegal_instruction, 0},
             Case{encode(lw, {.rd = 7, .immediate = 1026}), StopReason::unaligned_access, 1026},
             Case{encode(sh, {.immediate = 1025}), StopReason::unaligned_access, 1025},
             Case{encode(lb, {.rd = 7, .rs1 = 6}), StopReason::outside_access, 0xfffffffc},
             Case{encode(sw, {.rs1 = 6, .immediate = -8}), StopReason::outside_access, 0xfffffff4},
             Case{encode(sw, {.rs1 = 5, .rs2 = 6}), StopReason::store_into_flash, kFlash},
             Case{encode(sb, {.rs2 = 6, .immediate = 7}), StopReason::store_into_code, 7},
             Case{encode(jal, {.rd = 7, .immediate = 4096}), StopReason::jump_outside, 4100},
             Case{encode(jal, {.rd = 7, .immediate = 6}), StopReason::jump_outside, 10},
             Case{encode(beq, {.immediate = -8}), StopReason::jump_outside, 0xfffffffc},
             Case{encode(jalr, {.rd = 7, .rs1 = 6}), StopReason::jump_outside, 0xfffffffc},
             Case{encode(jalr, {.rd = 7, .immediate = 7}), StopReason::jump_outside, 6},
         }) {
        MemoryImage image;
        std::ranges::copy(bytes_of({encode(addi, {.rd = 8, .immediate = 1}), expected.word}), image.bytes.begin());
        image.flash.resize(16);
        Code const code = decode_code(0, std::span(image.bytes).first(8), kOneCycleEach);
        Memory memory(std::make_shared<MemoryImage const>(std::move(image)));
        Core core;
        core.x[5] = kFlash;
        core.x[6] = 0xfffffffc;
        core.x[7] = 77;
        Core before = core;
        before.x[8] = 1;
        before.pc = 4;
        before.cycles = 1;
        EXPECT_EQ(run(core, memory, code, 100), (Stop{expected.reason, 4, expected.address}));
        EXPECT_EQ(core, before);
        EXPECT_EQ(memory.copied_pages(), 0U);
        // Again, and again.
        EXPECT_EQ(run(core, memory, code, 100), (Stop{expected.reason, 4, expected.address}));
    }
}

TEST(RiscvCore, BranchOutsideIsAMistakeOnlyIfItIsTaken) {
    Robot robot({encode(bne, {.immediate = -8}), encode(beq, {.rs1 = 5, .immediate = 100}), encode(ecall)});
    robot.core.x[5] = 1;
    EXPECT_EQ(robot.run(), (Stop{StopReason::ecall, 8, 0}));
    robot.core = {};
    EXPECT_EQ(robot.run(), (Stop{StopReason::jump_outside, 4, 104}));
}

TEST(RiscvCore, CodeHasAnEndAndABeginning) {
    Robot robot({encode(fence), encode(fence)}, kOneCycleEach);
    EXPECT_EQ(robot.run(), (Stop{StopReason::jump_outside, 8, 8}));
    EXPECT_EQ(robot.core.cycles, 2U);
    EXPECT_EQ(robot.run(), (Stop{StopReason::jump_outside, 8, 8}));
    robot.core.pc = 2;
    EXPECT_EQ(robot.run(), (Stop{StopReason::jump_outside, 2, 2}));
    robot.core.pc = 0xfffffffc;
    EXPECT_EQ(robot.run(), (Stop{StopReason::jump_outside, 0xfffffffc, 0xfffffffc}));
}

TEST(RiscvCore, CodeMayBeAnywhere) {
    auto const bytes = bytes_of({encode(auipc, {.rd = 5, .immediate = 4096}), encode(jal, {.rd = 1, .immediate = 8}),
                                 encode(ebreak), encode(ecall)});
    Code const code = decode_code(0x20000100, bytes);
    Memory memory(std::make_shared<MemoryImage const>());
    Core core{.x = {}, .pc = 0x20000100, .cycles = 0};
    EXPECT_EQ(run(core, memory, code, 100), (Stop{StopReason::ecall, 0x2000010c, 0}));
    EXPECT_EQ(core.x[5], 0x20001100U);
    EXPECT_EQ(core.x[1], 0x20000108U);
}

TEST(RiscvCore, StopsAtInterceptedFunctionsEachTime) {
    // Calls the function at 16 twice, which would be an ebreak.
    auto const bytes = bytes_of({encode(jal, {.rd = 1, .immediate = 16}), encode(jal, {.rd = 1, .immediate = 12}),
                                 encode(ecall), encode(ebreak), encode(ebreak)});
    Code code = decode_code(0, bytes, kOneCycleEach);
    EXPECT_TRUE(intercept(code, 16));
    EXPECT_FALSE(intercept(code, 20));
    EXPECT_FALSE(intercept(code, 17));
    Memory memory(std::make_shared<MemoryImage const>());
    Core core;
    int calls = 0;
    Stop stop;
    while ((stop = run(core, memory, code, 100)).reason == StopReason::intercepted) {
        EXPECT_EQ(stop, (Stop{StopReason::intercepted, 16, 0}));
        EXPECT_EQ(run(core, memory, code, 100), stop);  // still there
        ++calls;
        core.x[10] += 5;
        core.pc = core.x[1];
    }
    EXPECT_EQ(stop, (Stop{StopReason::ecall, 8, 0}));
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(core.x[10], 10U);
    EXPECT_EQ(core.cycles, 2U);
}

TEST(RiscvCore, RobotsOnTwoThreadsDoWhatOneAloneDoes) {
    Robot alone(long_loop(2000));
    alone.run();
    Robot first(long_loop(2000));
    Memory second_memory(first.image);  // the same image and code
    Core second_core;
    auto const run_in_pieces = [&](Core& core, Memory& memory) {
        while (run(core, memory, *first.code, 1000).reason == StopReason::budget_used) {
        }
    };
    std::thread thread([&] { run_in_pieces(second_core, second_memory); });
    run_in_pieces(first.core, first.memory);
    thread.join();
    EXPECT_EQ(first.core, alone.core);
    EXPECT_EQ(second_core, alone.core);
    EXPECT_EQ(*first.memory.readable<1>(1024), *alone.memory.readable<1>(1024));
    EXPECT_EQ(*second_memory.readable<1>(1024), *alone.memory.readable<1>(1024));
    EXPECT_EQ(second_memory.copied_pages(), 1U);
}

TEST(RiscvCore, ReadsItsCounterOfCyclesAndNoOtherRegister) {
    constexpr std::uint32_t read_cycle = 0xc0002573;            // rdcycle a0
    constexpr std::uint32_t read_upper_half = 0xb80025f3;       // csrr a1, mcycleh
    constexpr std::uint32_t set_interrupt_mask = 0xbc02a673;    // csrrs a2, 0xbc0, t0: VexRiscv's
    constexpr std::uint32_t write_without_result = 0x30529073;  // csrw mtvec, t0
    Robot robot({write_without_result, set_interrupt_mask, read_cycle, read_upper_half, encode(Operation::ebreak)},
                kOneCycleEach);
    robot.core.x[5] = robot.core.x[12] = 7;
    robot.core.cycles = (std::uint64_t{3} << 32) + 100;
    EXPECT_EQ(robot.run(), (Stop{StopReason::ebreak, 16, 0}));
    EXPECT_EQ(robot.core.x[10], 102U);
    EXPECT_EQ(robot.core.x[11], 3U);
    EXPECT_EQ(robot.core.x[12], 0U);
    EXPECT_EQ(robot.core.x[0], 0U);
    EXPECT_EQ(robot.core.cycles, (std::uint64_t{3} << 32) + 104);
}

TEST(RiscvCore, EndsBeforeAnAccessForWhichNoCycleIsLeft) {
    Robot robot({0xc0002573, 0xc0002573}, kOneCycleEach);
    EXPECT_EQ(robot.run(1), (Stop{StopReason::budget_used, 4, 0}));
    EXPECT_EQ(robot.core.cycles, 1U);
}

TEST(RiscvCore, StopsWhereItWouldWaitForAnInterrupt) {
    Robot robot({encode(Operation::wfi)});
    EXPECT_EQ(robot.run(), (Stop{StopReason::wait_for_interrupt, 0, 0}));
}

}  // namespace
