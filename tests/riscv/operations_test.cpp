// Each operation does what the reference does, on numbers where operations differ.
#include <gtest/gtest.h>

#include <string>

#include "riscv/reference_core.hpp"
#include "riscv/robot.hpp"

namespace {

using namespace pogosim;
using namespace pogosim::testing;

constexpr std::uint32_t kNumbers[] = {
    0,          1,          2,          3,          31,         32,         33,         0x7f,       0x80,
    0xff,       0x7fff,     0x8000,     0xffff,     0x10000,    0x12345678, 0x7ffffffe, 0x7fffffff, 0x80000000,
    0x80000001, 0x89abcdef, 0xdeadbeef, 0xffff8000, 0xffffff80, 0xfffffffe, 0xffffffff};
constexpr std::uint32_t kCodeWords = 64;
constexpr std::uint32_t kData = 4 * kCodeWords;  // address

/// Executes one word at an address, by both; they must agree on everything.
void expect_same(std::vector<std::uint32_t>& words, std::uint32_t at, std::uint32_t word, std::uint32_t a,
                 std::uint32_t b) {
    words[at / 4] = word;
    Robot robot(words, kOneCycleEach, 1024);
    robot.core.pc = at;
    robot.core.x[5] = a;
    robot.core.x[6] = b;
    robot.core.x[7] = 77;
    ReferenceCore reference{.x = robot.core.x, .pc = at, .memory = {}, .code_bytes = 4 * kCodeWords};
    for (std::uint32_t i = 0; i < kData + 128; ++i) {
        auto const byte = i < 4 * kCodeWords ? robot.image->bytes[i] : static_cast<std::byte>(0x81 + 3 * i);
        reference.memory.push_back(std::to_integer<std::uint8_t>(byte));
        if (i >= kData) {
            robot.memory.write(i, {&byte, 1});
        }
    }
    bool const is_executed = reference.step();
    Stop const stop = robot.run(1);
    EXPECT_EQ(stop.reason == StopReason::budget_used, is_executed);
    EXPECT_EQ(robot.core.cycles, is_executed ? 1U : 0U);
    EXPECT_EQ(robot.core.x, reference.x);
    EXPECT_EQ(robot.core.pc, reference.pc);
    for (std::uint32_t i = kData; i < kData + 64; ++i) {
        ASSERT_EQ(std::to_integer<std::uint8_t>(*robot.memory.readable<1>(i)), reference.memory[i]);
    }
    words[at / 4] = 0;
}

class RiscvOperation : public ::testing::TestWithParam<Encoding> {};

TEST_P(RiscvOperation, DoesWhatTheManualSays) {
    std::vector<std::uint32_t> words(kCodeWords);
    Encoding const& encoding = GetParam();
    bool const accesses = encoding.opcode == 0x03 || encoding.opcode == 0x23;
    for (std::uint32_t const a : kNumbers) {
        for (std::uint32_t const b : kNumbers) {
            std::int32_t const immediate = encoding.format == 'U' ? static_cast<std::int32_t>(b & 0xfffff000U)
                                                                  : static_cast<std::int32_t>(b % 4096) - 2048;
            // Accesses to data, and some to code, to no memory, and unaligned ones.
            std::uint32_t const place = a == 3 ? 8192 : a == 2 ? 64 : kData + a % 64;
            std::uint32_t const base = accesses ? place - static_cast<std::uint32_t>(immediate) : a;
            for (std::uint32_t const rd : {0U, 5U, 7U}) {
                std::uint32_t const word = encode(encoding, {.rd = rd, .rs1 = 5, .rs2 = 6, .immediate = immediate});
                expect_same(words, 128, word, base, b);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Each, RiscvOperation, ::testing::ValuesIn(kEncodings),
                         [](auto const& tested) { return "Encoding" + std::to_string(tested.index); });

std::uint32_t result_of(Operation operation, std::uint32_t a, std::uint32_t b) {
    Robot robot({encode(operation, {.rd = 7, .rs1 = 5, .rs2 = 6}), encode(Operation::ecall)});
    robot.core.x[5] = a;
    robot.core.x[6] = b;
    EXPECT_EQ(robot.run().reason, StopReason::ecall);
    return robot.core.x[7];
}

TEST(RiscvDivision, ByZeroAndOverflowHaveTheResultsOfTheManual) {
    constexpr std::uint32_t kLeast = 0x80000000U;
    constexpr std::uint32_t kMinusOne = 0xffffffffU;
    EXPECT_EQ(result_of(Operation::div, 42, 0), kMinusOne);
    EXPECT_EQ(result_of(Operation::divu, 42, 0), kMinusOne);
    EXPECT_EQ(result_of(Operation::rem, 42, 0), 42U);
    EXPECT_EQ(result_of(Operation::remu, 42, 0), 42U);
    EXPECT_EQ(result_of(Operation::div, kLeast, kMinusOne), kLeast);
    EXPECT_EQ(result_of(Operation::rem, kLeast, kMinusOne), 0U);
    EXPECT_EQ(result_of(Operation::div, static_cast<std::uint32_t>(-7), 2), static_cast<std::uint32_t>(-3));
    EXPECT_EQ(result_of(Operation::rem, static_cast<std::uint32_t>(-7), 2), static_cast<std::uint32_t>(-1));
}

TEST(RiscvMultiplication, HasTheUpperHalvesOfAllSigns) {
    constexpr std::uint32_t kMinusOne = 0xffffffffU;
    EXPECT_EQ(result_of(Operation::mulh, kMinusOne, kMinusOne), 0U);
    EXPECT_EQ(result_of(Operation::mulhu, kMinusOne, kMinusOne), 0xfffffffeU);
    EXPECT_EQ(result_of(Operation::mulhsu, kMinusOne, kMinusOne), kMinusOne);
    EXPECT_EQ(result_of(Operation::mulh, 0x80000000U, 0x80000000U), 0x40000000U);
    EXPECT_EQ(result_of(Operation::mulhsu, 0x80000000U, 0x80000000U), 0xc0000000U);
}

}  // namespace
