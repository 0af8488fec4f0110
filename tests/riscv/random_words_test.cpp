// Random words as programs: none does harm, each stop has its reason, and the reference agrees on what happened.
#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "riscv/reference_core.hpp"
#include "riscv/robot.hpp"

namespace {

using namespace pogosim;
using namespace pogosim::testing;

constexpr int kPrograms = 10'000;
constexpr std::uint64_t kSteps = 10'000;
constexpr std::uint32_t kWords = 128;
constexpr std::uint32_t kBytes = 4096;  // of memory
constexpr std::uint32_t kLast = static_cast<std::uint32_t>(std::size(kEncodings)) - 1;

class Generator {
public:
    /// Jumps and branches go up to `reach` words back, and nearly as far on.
    explicit Generator(std::uint64_t seed, int reach = 32) : state_(seed * 0x9e3779b97f4a7c15U + 1), reach_(reach) {}

    std::uint32_t next() {  // xorshift64*, G. Marsaglia and S. Vigna
        state_ ^= state_ >> 12;
        state_ ^= state_ << 25;
        state_ ^= state_ >> 27;
        return static_cast<std::uint32_t>(state_ * 0x2545f4914f6cdd1dU >> 32);
    }

    std::uint32_t below(std::uint32_t end) { return next() % end; }

    /// One word in eight is any; the others are instructions, with few registers.
    std::uint32_t word() {
        if (below(8) == 0) {
            return next();
        }
        Encoding const& encoding = kEncodings[below(kLast + 1)];
        bool const is_jump = encoding.format == 'B' || encoding.format == 'J';
        auto const number = static_cast<std::int32_t>(next());
        return encode(
            encoding,
            {.rd = below(8), .rs1 = below(8), .rs2 = below(8), .immediate = is_jump ? number % reach_ * 4 : number});
    }

private:
    std::uint64_t state_;
    int reach_;
};

std::vector<std::uint32_t> random_words(Generator& random, std::uint32_t count = kWords) {
    std::vector<std::uint32_t> words(count);
    std::ranges::generate(words, [&] { return random.word(); });
    return words;
}

/// Something else for a robot that cannot go on: other registers, another place.
void restart(Core& core, Generator& random, std::uint32_t words = kWords) {
    for (std::uint32_t i = 1; i < 8; ++i) {
        core.x[i] = random.below(4) == 0 ? random.next() : random.below(kBytes);
    }
    core.pc = 4 * random.below(words);
}

/// Why a step cannot be executed, from its word.
void expect_reason(Stop const& stop, Robot const& robot) {
    Instruction const at = decode(read_little_endian<4>(&robot.image->bytes[stop.pc]));
    std::uint32_t const sum = robot.core.x[at.rs1] + static_cast<std::uint32_t>(at.immediate);
    switch (stop.reason) {
        case StopReason::illegal_instruction:
            EXPECT_EQ(at.operation, Operation::illegal);
            break;
        case StopReason::ecall:
            EXPECT_EQ(at.operation, Operation::ecall);
            break;
        case StopReason::ebreak:
            EXPECT_EQ(at.operation, Operation::ebreak);
            break;
        case StopReason::wait_for_interrupt:
            EXPECT_EQ(at.operation, Operation::wfi);
            break;
        case StopReason::unaligned_access:
            EXPECT_EQ(stop.address, sum);
            EXPECT_NE(stop.address % 4, 0U);
            break;
        case StopReason::outside_access:
            EXPECT_EQ(stop.address, sum);
            EXPECT_GE(stop.address, kBytes);
            break;
        case StopReason::store_into_code:
            EXPECT_EQ(stop.address, sum);
            EXPECT_LT(stop.address, 4 * kWords);
            break;
        case StopReason::jump_outside:
            EXPECT_TRUE(stop.address % 4 != 0 || stop.address >= 4 * kWords);
            break;
        default:
            ADD_FAILURE() << static_cast<int>(stop.reason);
            break;
    }
}

TEST(RiscvRandomWords, StopWithAReasonAndDoNoHarm) {
    std::uint64_t steps = 0;
    for (int program = 0; program < kPrograms; ++program) {
        Generator random(static_cast<std::uint64_t>(program));
        Robot robot(random_words(random), kOneCycleEach, kBytes);
        for (int attempt = 0; attempt < 20 && robot.core.cycles < kSteps; ++attempt) {
            restart(robot.core, random);
            std::uint64_t const before = robot.core.cycles;
            Stop const stop = robot.run(kSteps - before);
            ASSERT_EQ(robot.core.x[0], 0U);
            ASSERT_EQ(stop.pc, robot.core.pc);
            if (stop.reason == StopReason::budget_used) {
                ASSERT_EQ(robot.core.cycles, kSteps);
            } else if (stop.pc < 4 * kWords) {
                expect_reason(stop, robot);
            } else {
                ASSERT_EQ(stop, (Stop{StopReason::jump_outside, 4 * kWords, 4 * kWords}));
            }
            ASSERT_FALSE(HasFailure()) << "program " << program;
        }
        steps += robot.core.cycles;
    }
    EXPECT_GT(steps, kPrograms * kSteps / 10);  // many run in loops
}

TEST(RiscvRandomWords, DoWhatTheReferenceDoes) {
    for (int program = 0; program < 1000; ++program) {
        Generator random(static_cast<std::uint64_t>(program));
        Robot robot(random_words(random), kOneCycleEach, kBytes);
        ReferenceCore reference{.x = {}, .pc = 0, .memory = {}, .code_bytes = 4 * kWords};
        for (std::byte const byte : robot.image->bytes) {
            reference.memory.push_back(std::to_integer<std::uint8_t>(byte));
        }
        for (int attempt = 0; attempt < 20; ++attempt) {
            restart(robot.core, random);
            reference.x = robot.core.x;
            reference.pc = robot.core.pc;
            std::uint64_t const budget = random.below(2000);
            std::uint64_t const begin = robot.core.cycles;
            std::uint64_t done = 0;
            reference.cycles = static_cast<std::int64_t>(begin);
            while (done < budget && reference.step()) {
                ++done;
                ++reference.cycles;
            }
            Stop const stop = robot.run(budget);
            ASSERT_EQ(robot.core.cycles - begin, done)
                << "program " << program << ", stopped for reason " << static_cast<int>(stop.reason) << " at "
                << stop.pc << " word " << std::hex << read_little_endian<4>(&robot.image->bytes[stop.pc]);
            ASSERT_EQ(robot.core.pc, reference.pc) << "program " << program;
            ASSERT_EQ(robot.core.x, reference.x) << "program " << program;
        }
        std::vector<std::byte> bytes(kBytes);
        robot.memory.read(0, bytes);
        ASSERT_TRUE(std::ranges::equal(bytes, reference.memory, {},
                                       [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); }))
            << "program " << program;
    }
}

/// The number of the line that each place of the instruction cache holds, -1: none.
using PlainCache = std::array<std::int64_t, 64>;

bool misses(PlainCache& cache, std::uint32_t address) {
    std::int64_t const line = address / 32;
    std::int64_t& place = cache[address / 32 % 64];
    return std::exchange(place, line) != line;
}

TEST(RiscvRandomWords, MissTheCacheWhereTheReferenceDoes) {
    constexpr std::uint32_t kFarWords = 4096;  // 16 KiB of code, eight times what the cache holds
    constexpr std::int64_t kMiss = 7;
    CycleCosts costs = kOneCycleEach;
    costs.cache_miss = kMiss;
    std::uint64_t all_misses = 0;
    for (int program = 0; program < 100; ++program) {
        Generator random(static_cast<std::uint64_t>(program), 1024);
        Robot robot(random_words(random, kFarWords), costs, 2 * 4 * kFarWords);
        ReferenceCore reference{.x = {}, .pc = 0, .memory = {}, .code_bytes = 4 * kFarWords};
        for (std::byte const byte : robot.image->bytes) {
            reference.memory.push_back(std::to_integer<std::uint8_t>(byte));
        }
        PlainCache cache;
        cache.fill(-1);
        for (int attempt = 0; attempt < 1000; ++attempt) {
            restart(robot.core, random, kFarWords);
            reference.x = robot.core.x;
            reference.pc = robot.core.pc;
            auto const end = static_cast<std::int64_t>(robot.core.cycles + random.below(2000));
            reference.cycles = static_cast<std::int64_t>(robot.core.cycles);
            for (std::uint32_t pc = reference.pc; reference.cycles < end && reference.step(); pc = reference.pc) {
                reference.cycles += 1 + (misses(cache, pc) ? kMiss : 0);
            }
            robot.run(static_cast<std::uint64_t>(end) - robot.core.cycles);
            ASSERT_EQ(robot.core.cycles, static_cast<std::uint64_t>(reference.cycles)) << "program " << program;
            ASSERT_EQ(robot.core.pc, reference.pc) << "program " << program;
            ASSERT_EQ(robot.core.x, reference.x) << "program " << program;
        }
        all_misses += robot.core.cache.misses;
    }
    EXPECT_GT(all_misses, 50'000U);
}

}  // namespace
