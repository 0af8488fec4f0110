#include "sim/heard_messages.hpp"

#include <gtest/gtest.h>

#include "support/small_world.hpp"

namespace pogosim {
namespace {

DeliveryLog delivered(std::int64_t step, std::uint32_t sender, std::uint32_t receiver, std::uint8_t queued) {
    DeliveryLog log;
    log.step = step;
    log.air.transmissions.emplace_back().robot = sender;
    log.deliveries.push_back({.transmission = 0, .receiver = receiver, .is_received = queued > 0, .queued = queued});
    return log;
}

TEST(HeardMessages, AreThoseOfTheLastSecondEachPairOnce) {
    World world = testing::square_world();
    world.time_step_s = 0.1;
    HeardMessages heard;
    heard.note(world, delivered(0, 1, 2, 1));
    heard.note(world, delivered(4, 1, 2, 1));
    heard.note(world, delivered(5, 2, 1, 1));
    heard.note(world, delivered(6, 3, 1, 0));      // lost
    heard.note(world, delivered(6, 3, kNone, 0));  // none was in range
    auto const found = heard.until(1.0);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].sender, 1U);
    EXPECT_EQ(found[0].receiver, 2U);
    EXPECT_DOUBLE_EQ(found[0].time_s, 0.5);
    EXPECT_EQ(found[1].sender, 2U);
    EXPECT_EQ(heard.until(1.55).size(), 1U);
    EXPECT_TRUE(heard.until(3.0).empty());
    heard.note(world, delivered(50, 1, 2, 1));
    heard.clear();
    EXPECT_TRUE(heard.until(5.5).empty());
}

}  // namespace
}  // namespace pogosim
