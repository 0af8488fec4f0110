#include "view/run_requests.hpp"

#include <gtest/gtest.h>

namespace pogosim {
namespace {

TEST(RunRequests, AreShownBeforeTheRunHasAnswered) {
    Exchange exchange;
    RunRequests requests(exchange, {});
    EXPECT_EQ(requests.send(Pause{true}), "");
    EXPECT_EQ(requests.send(SetSpeedUp{5.0}), "");
    requests.take({.paused = false, .asked_speed_up = 1.0, .touched = true});  // from before
    EXPECT_TRUE(requests.status().paused);
    EXPECT_EQ(requests.status().asked_speed_up, 5.0);
    EXPECT_TRUE(requests.status().touched);
    EXPECT_TRUE(std::holds_alternative<Pause>(*exchange.take_command()));
    EXPECT_EQ(std::get<SetSpeedUp>(*exchange.take_command()).factor, 5.0);
}

TEST(RunRequests, AConditionPausesTheRunOnce) {
    Exchange exchange;
    RunRequests requests(exchange, {});
    requests.take({.paused = true, .why_paused = "robot 0: x = 3"});
    EXPECT_TRUE(requests.status().paused);
    requests.send(Pause{false});
    requests.take({.paused = true, .why_paused = "robot 0: x = 3"});  // from before
    EXPECT_FALSE(requests.status().paused);
}

TEST(RunRequests, OfARunThatIsOverSayWhatToDo) {
    Exchange exchange;
    RunRequests requests(exchange, {.is_over = true});
    EXPECT_NE(requests.send(StepOnce{}).find("R runs it again"), std::string::npos);
    EXPECT_FALSE(exchange.take_command());
    EXPECT_EQ(requests.send(SetSpeedUp{2.0}), "");
}

TEST(RunRequests, SpeedChangesByAFactorAndFromNoLimitToASlowerOne) {
    Exchange exchange;
    RunRequests requests(exchange, {.asked_speed_up = 2.0, .speed_up = 50.0});
    requests.change_speed(0.5);
    EXPECT_EQ(requests.status().asked_speed_up, 1.0);
    requests.send(SetSpeedUp{0.0});
    requests.change_speed(2.0);  // there is none above
    EXPECT_EQ(requests.status().asked_speed_up, 0.0);
    requests.change_speed(0.5);
    EXPECT_EQ(requests.status().asked_speed_up, 25.0);
}

}  // namespace
}  // namespace pogosim
