// Copies of a program's variables: plain arrays stand for the pieces of its memory.
#include "robot/robot_memory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <vector>

namespace pogosim {
namespace {

template <class T>
std::span<std::byte> bytes_of(T& variable) {
    return std::as_writable_bytes(std::span(&variable, 1));
}

struct Variables {
    std::array<std::uint8_t, 1000> large{};
    std::array<std::uint8_t, 3> small{1, 2, 3};

    std::vector<std::span<std::byte>> pieces() { return {bytes_of(large), bytes_of(small)}; }
};

TEST(RobotMemory, EveryCopyCanBeReadWhateverIsLoaded) {
    constexpr std::uint32_t kCopies = 5;
    Variables program;
    RobotMemory memory(program.pieces(), kCopies);
    for (std::uint32_t copy = 0; copy < kCopies; ++copy) {
        memory.load(copy);
        program.large[70] = static_cast<std::uint8_t>(10 + copy);
        program.small[2] = static_cast<std::uint8_t>(20 + copy);
    }
    for (std::uint32_t loaded : {kNone, 0U, 3U}) {
        memory.load(loaded);
        for (std::uint32_t copy = 0; copy < kCopies; ++copy) {
            std::array<std::byte, 10> read{};
            memory.read(copy, bytes_of(program.large).data() + 65, read);
            EXPECT_EQ(static_cast<unsigned>(read[5]), 10U + copy) << loaded;
            EXPECT_EQ(static_cast<unsigned>(read[4]), 0U);
            memory.read(copy, bytes_of(program.small).data() + 2, std::span(read).first(1));
            EXPECT_EQ(static_cast<unsigned>(read[0]), 20U + copy) << loaded;
        }
    }
}

TEST(RobotMemory, EachCopyKeepsWhatItWasGiven) {
    constexpr std::uint32_t kCopies = 50;
    Variables program;
    std::iota(program.large.begin(), program.large.end(), std::uint8_t{0});
    std::vector<Variables> expected(kCopies, program);
    RobotMemory memory(program.pieces(), kCopies);
    std::minstd_rand random(7);
    for (int round = 0; round < 3000; ++round) {
        std::uint32_t const copy = static_cast<std::uint32_t>(random()) % kCopies;
        memory.load(copy);
        ASSERT_EQ(program.large, expected[copy].large) << "copy " << copy << ", round " << round;
        ASSERT_EQ(program.small, expected[copy].small) << "copy " << copy << ", round " << round;
        auto const value = static_cast<std::uint8_t>(random());
        // At most where the number of the round allows: ever more of the memory differs between copies.
        std::size_t const place = random() % (1 + static_cast<std::size_t>(round) / 3);
        program.large[place] = expected[copy].large[place] = value;
        program.small[random() % 3] = value;
        expected[copy].small = program.small;
    }
}

TEST(RobotMemory, CopiesOnlyWhatSomeRobotChanges) {
    std::vector<std::byte> program(std::size_t{1} << 20U);
    std::array const pieces{std::span(program)};
    RobotMemory memory(pieces, 1000);
    for (std::uint32_t copy = 0; copy < 1000; ++copy) {
        memory.load(copy);
        program[5000] = std::byte(copy);
        program[900000] = std::byte(1);
    }
    memory.load(0);
    EXPECT_EQ(memory.bytes(), program.size());
    EXPECT_LE(memory.copied_bytes(), 2 * 64);
    EXPECT_EQ(program[5000], std::byte(0));
    memory.load(999);
    EXPECT_EQ(program[5000], std::byte(999 & 0xFF));
}

TEST(RobotMemory, WhatIsGivenToAllIsInEveryCopy) {
    Variables program;
    RobotMemory memory(program.pieces(), 4);
    memory.load(1);
    program.large[100] = 11;  // own: the bytes beside what all get
    program.large[102] = 13;
    memory.load(2);
    program.large[101] = 42;
    memory.give_to_all(bytes_of(program.large[101]));
    program.small[0] = 9;
    memory.give_to_all(bytes_of(program.small[0]));
    for (std::uint32_t const copy : {0U, 1U, 2U, 3U, kNone}) {
        memory.load(copy);
        EXPECT_EQ(program.large[101], 42) << copy;
        EXPECT_EQ(program.small[0], 9) << copy;
        EXPECT_EQ(program.large[100], copy == 1 ? 11 : 0) << copy;
        EXPECT_EQ(program.large[102], copy == 1 ? 13 : 0) << copy;
    }
}

TEST(RobotMemory, ACommonChangeLeavesTheRestToEachCopy) {
    Variables program;
    RobotMemory memory(program.pieces(), 3);
    memory.load(1);
    program.large[7] = 1;
    memory.load(2);
    program.large[7] = 2;
    memory.begin_common_change();
    program.large[8] = 5;
    program.small[2] = 6;
    memory.end_common_change();
    for (std::uint32_t const copy : {0U, 1U, 2U, kNone}) {
        memory.load(copy);
        EXPECT_EQ(program.large[7], copy == kNone ? 0 : copy);
        EXPECT_EQ(program.large[8], 5);
        EXPECT_EQ(program.small[2], 6);
    }
}

TEST(RobotMemory, ACommonChangeIsMadeAgainInACopyThatBeginsAnew) {
    Variables program;
    RobotMemory memory(program.pieces(), 3);
    memory.load(2);
    memory.begin_common_change();
    program.large[8] = 5;
    program.small[2] = 6;
    memory.end_common_change();
    memory.load(1);
    program.large[7] = program.large[8] = 9;
    memory.begin_anew(1);
    EXPECT_EQ(program.large[8], 0);
    memory.repeat_common_changes();
    memory.load(0);
    memory.load(1);
    EXPECT_EQ(program.large[7], 0);
    EXPECT_EQ(program.large[8], 5);
    EXPECT_EQ(program.small[2], 6);
    program.large[8] = 7;
    memory.give_to_all(bytes_of(program.large[8]));
    memory.begin_anew(2);
    memory.repeat_common_changes();
    EXPECT_EQ(program.large[8], 7);
    EXPECT_EQ(program.small[2], 6);
}

TEST(RobotMemory, ChangedPartsAreWhatACopyHasElse) {
    Variables program;
    RobotMemory memory(program.pieces(), 2);
    EXPECT_TRUE(memory.changed_parts(0).empty());
    memory.load(1);
    program.small[1] = 77;
    auto const parts = memory.changed_parts(1);
    ASSERT_EQ(parts.size(), 1U);
    ASSERT_EQ(parts[0].bytes.size(), 3U);
    EXPECT_EQ(parts[0].bytes[1], std::byte(77));
    EXPECT_TRUE(memory.changed_parts(0).empty());
    EXPECT_TRUE(memory.changed_parts(kNone).empty());
}

TEST(RobotMemory, WhatAllRobotsHaveSetToTheSameIsNotCopiedAnyMore) {
    Variables program;
    RobotMemory memory(program.pieces(), 3);
    for (int round = 0; round < 200; ++round) {
        for (std::uint32_t robot = 0; robot < 3; ++robot) {
            memory.load(robot);
            ASSERT_EQ(program.large[0], round == 0 ? 0 : 1);
            ASSERT_EQ(program.large[999], round == 0 ? 0 : 1);
            ASSERT_EQ(program.large[500], round == 0 ? 0 : robot);
            program.large.fill(1);
            program.large[500] = static_cast<std::uint8_t>(robot);
        }
    }
    EXPECT_EQ(memory.copied_bytes(), 64U);
    memory.load(kNone);
    EXPECT_EQ(program.large[0], 0);
    program.large[0] = 5;
    memory.load(2);
    EXPECT_EQ(program.large[0], 1);
    EXPECT_EQ(program.large[500], 2);
    memory.load(kNone);
    EXPECT_EQ(program.large[0], 5);
    EXPECT_EQ(program.large[500], 0);
    EXPECT_EQ(memory.changed_parts(0).size(), 16U);  // whatever is copied
    EXPECT_EQ(memory.changed_parts(kNone).size(), 1U);
}

TEST(RobotMemory, WithoutVariablesThereIsNothingToDo) {
    RobotMemory memory({}, 5);
    memory.load(3);
    memory.load(1);
    EXPECT_EQ(memory.bytes(), 0U);
}

}  // namespace
}  // namespace pogosim
