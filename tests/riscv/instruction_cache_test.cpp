// What code that is not in the instruction cache costs.
#include "riscv/instruction_cache.hpp"

#include <gtest/gtest.h>

#include "riscv/robot.hpp"

namespace {

using namespace pogosim;
using namespace pogosim::testing;
using enum Operation;

constexpr std::uint32_t kMiss = 20;
constexpr std::uint32_t kWordsOfALine = kCacheLineBytes / 4;
constexpr std::uint32_t kWordsOfTheCache = kCacheLines * kWordsOfALine;

constexpr CycleCosts with_misses() {
    CycleCosts costs = kOneCycleEach;
    costs.cache_miss = kMiss;
    return costs;
}

/// Words that do nothing, then ecall.
std::vector<std::uint32_t> straight(std::uint32_t words) {
    std::vector<std::uint32_t> result(words, encode(addi));
    result.push_back(encode(ecall));
    return result;
}

/// x5 counts down from a number; each time, two functions are called, which begin so many words after the beginning.
std::vector<std::uint32_t> calls_of_two(std::int32_t times, std::uint32_t first, std::uint32_t second) {
    auto const distance = [](std::uint32_t from, std::uint32_t to) {
        return static_cast<std::int32_t>(4 * to) - static_cast<std::int32_t>(4 * from);
    };
    std::vector<std::uint32_t> words(second + 1, encode(ebreak));
    words[0] = encode(addi, {.rd = 5, .immediate = times});
    words[1] = encode(jal, {.rd = 1, .immediate = distance(1, first)});
    words[2] = encode(jal, {.rd = 1, .immediate = distance(2, second)});
    words[3] = encode(addi, {.rd = 5, .rs1 = 5, .immediate = -1});
    words[4] = encode(bne, {.rs1 = 5, .immediate = distance(4, 1)});
    words[5] = encode(ecall);
    words[first] = encode(jalr, {.rs1 = 1});
    words[second] = encode(jalr, {.rs1 = 1});
    return words;
}

std::uint64_t misses_of(std::vector<std::uint32_t> const& words) {
    Robot robot(words, with_misses());
    Robot without(words, kOneCycleEach);
    EXPECT_EQ(robot.run().reason, StopReason::ecall);
    EXPECT_EQ(without.run().reason, StopReason::ecall);
    EXPECT_EQ(robot.core.cycles, without.core.cycles + kMiss * robot.core.cache.misses);
    EXPECT_EQ(without.core.cache, InstructionCache{});
    return robot.core.cache.misses;
}

TEST(RiscvCache, FetchesEachLineOfStraightCodeOnce) {
    for (std::uint32_t const words : {1U, 7U, 8U, 9U, 16U, 17U, 1000U}) {
        EXPECT_EQ(misses_of(straight(words)), (words + kWordsOfALine - 1) / kWordsOfALine) << words;
    }
}

TEST(RiscvCache, StopCostsNothing) {
    Robot robot(straight(0), with_misses());
    EXPECT_EQ(robot.run().reason, StopReason::ecall);
    EXPECT_EQ(robot.core, Core{});
    Robot second(straight(kWordsOfALine), with_misses());
    EXPECT_EQ(second.run().reason, StopReason::ecall);
    EXPECT_EQ(second.core.cycles, kWordsOfALine + kMiss);  // ecall is in the second line
}

TEST(RiscvCache, HoldsWhatALoopNeeds) {
    EXPECT_EQ(misses_of(calls_of_two(1, 100, 200)), 3U);
    EXPECT_EQ(misses_of(calls_of_two(1000, 100, 200)), 3U);
}

TEST(RiscvCache, LinesThatShareAPlacePushEachOtherOut) {
    EXPECT_EQ(misses_of(calls_of_two(1000, 100, 100 + kWordsOfTheCache)), 1U + 2 * 1000);
    EXPECT_EQ(misses_of(calls_of_two(1000, 96, 96 + kWordsOfTheCache - 1)), 3U);
    EXPECT_EQ(misses_of(calls_of_two(1000, 96, 96 + kWordsOfTheCache + kWordsOfALine)), 3U);
    // The second one has the place of the loop: its line is fetched again after each call.
    EXPECT_EQ(misses_of(calls_of_two(1000, 100, kWordsOfTheCache)), 2U + 2 * 1000);
}

TEST(RiscvCache, ReadingACounterIsAnInstructionToo) {
    std::vector<std::uint32_t> words = straight(kWordsOfALine);
    words.insert(words.begin() + kWordsOfALine, encode(csr, {.rd = 6, .immediate = 0xc00}));
    Robot robot(words, with_misses());
    EXPECT_EQ(robot.run().reason, StopReason::ecall);
    EXPECT_EQ(robot.core.cycles, kWordsOfALine + 1 + 2 * kMiss);
    EXPECT_EQ(robot.core.cache.misses, 2U);
}

TEST(RiscvCache, IsEmptyAtTheBeginning) {
    InstructionCache cache;
    for (std::uint32_t line = 0; line < 2 * kCacheLines; ++line) {
        EXPECT_TRUE(cache.fetches(line)) << line;
        EXPECT_FALSE(cache.fetches(line)) << line;
    }
}

}  // namespace
