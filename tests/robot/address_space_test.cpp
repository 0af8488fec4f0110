// What the state hash takes for an address.
#include "process/address_space.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>

#include "support/test_program.hpp"

namespace pogosim {
namespace {

int variables[2];

std::uint64_t word(void const* place) {
    return reinterpret_cast<std::uint64_t>(place);
}

TEST(AddressSpace, OfAnAddressInTheProgramItsOffsetCounts) {
    AddressSpace const space(testing::test_program());
    std::uint64_t const first = space.without_place(word(&variables[0]));
    EXPECT_EQ(space.without_place(word(&variables[1])), first + sizeof(int));
    EXPECT_LT(first, std::uint64_t{1} << 32U);
}

TEST(AddressSpace, AnyOtherAddressCountsTheSame) {
    AddressSpace const space(testing::test_program());
    auto const heap = std::make_unique<std::array<int, 1000>>();
    int local = 0;
    EXPECT_EQ(space.without_place(word(heap.get())), space.without_place(word(&local)));
    EXPECT_EQ(space.without_place(word(heap.get())), space.without_place(word(&(*heap)[7])));
}

TEST(AddressSpace, NumbersCountAsTheyAre) {
    AddressSpace const space(testing::test_program());
    constexpr std::uint64_t kOne = 1;
    for (std::uint64_t const number : {std::uint64_t{0}, kOne, 7 * kOne, kOne << 40U, ~std::uint64_t{0}}) {
        EXPECT_EQ(space.without_place(number), number);
    }
}

/// A word such as two counters of 32 bits: whether it counts as an address must not depend on what this run has mapped
/// there.
TEST(AddressSpace, NumberThatLooksLikeAnAddressIsOneInEveryRun) {
    AddressSpace const space(testing::test_program());
#ifdef __aarch64__
    std::uint64_t const upper_half = std::uint64_t{0xffff} << 32U;
#else
    std::uint64_t const upper_half = std::uint64_t{0x7ffe} << 32U;
#endif
    std::uint64_t const first = space.without_place(upper_half);
    for (std::uint64_t lower_half = 0; lower_half < std::uint64_t{1} << 32U; lower_half += 1U << 20U) {
        ASSERT_EQ(space.without_place(upper_half | lower_half), first);
    }
}

}  // namespace
}  // namespace pogosim
