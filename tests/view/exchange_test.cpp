#include "view/exchange.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace pogosim {
namespace {

using namespace std::chrono_literals;

std::vector<Command> all_commands(Exchange& exchange) {
    std::vector<Command> commands;
    while (auto command = exchange.take_command()) {
        commands.push_back(*command);
    }
    return commands;
}

TEST(Exchange, CommandsComeInTheirOrder) {
    Exchange exchange;
    exchange.send(Pause{true});
    exchange.send(StepOnce{});
    auto const commands = all_commands(exchange);
    ASSERT_EQ(commands.size(), 2U);
    EXPECT_TRUE(std::holds_alternative<Pause>(commands[0]));
    EXPECT_TRUE(std::holds_alternative<StepOnce>(commands[1]));
    EXPECT_TRUE(all_commands(exchange).empty());
}

TEST(Exchange, OfADragOnlyTheLastPlaceCounts) {
    Exchange exchange;
    for (int i = 0; i < 1000; ++i) {
        exchange.send(DragObject{3, {static_cast<float>(i), 0.0F}});
    }
    auto const commands = all_commands(exchange);
    ASSERT_EQ(commands.size(), 1U);
    EXPECT_EQ(std::get<DragObject>(commands[0]).centre_mm.x, 999.0F);
}

TEST(Exchange, EndIsAskedForByACommandThatIsNotTakenYetOrByAWindowThatIsGone) {
    Exchange exchange;
    exchange.send(Pause{true});
    EXPECT_FALSE(exchange.end_is_asked());
    for (Command const& end : {Command{Quit{}}, Command{Restart{}}}) {
        exchange.send(end);
        EXPECT_TRUE(exchange.end_is_asked());
        all_commands(exchange);
        EXPECT_FALSE(exchange.end_is_asked());
    }
    exchange.report_end(WindowEnd::closed, "");
    EXPECT_TRUE(exchange.end_is_asked());
}

TEST(Exchange, AMomentIsTakenOnce) {
    Exchange exchange;
    exchange.publish(std::make_shared<Moment>());
    EXPECT_NE(exchange.take_moment(), nullptr);
    EXPECT_EQ(exchange.take_moment(), nullptr);
}

TEST(Exchange, NothingRecordedIsLostWithAMomentThatWasNotTaken) {
    Exchange exchange;
    for (int i = 0; i < 3; ++i) {
        auto moment = std::make_shared<Moment>();
        moment->recorded.push_back({.time_s = static_cast<double>(i), .robot = {}, .values = {}});
        exchange.publish(moment);
    }
    auto const moment = exchange.take_moment();
    ASSERT_EQ(moment->recorded.size(), 3U);
    EXPECT_EQ(moment->recorded[0].time_s, 0.0);
    EXPECT_EQ(moment->recorded[2].time_s, 2.0);
}

TEST(Exchange, ACommandEndsTheWaitOfTheSimulation) {
    Exchange exchange;
    std::thread window([&] {
        std::this_thread::sleep_for(20ms);
        exchange.send(Quit{});
    });
    exchange.wait_until(Exchange::Clock::now() + 60s);
    EXPECT_EQ(all_commands(exchange).size(), 1U);
    window.join();
}

TEST(Exchange, AWindowThatDoesNotAnswerIsNotWaitedForForEver) {
    Exchange exchange;
    EXPECT_EQ(exchange.wait_until_opened(1ms), std::nullopt);
    EXPECT_FALSE(exchange.wait_until_ended(1ms));
    exchange.report_opened("no display");
    EXPECT_EQ(exchange.wait_until_opened(1ms), "no display");
    exchange.report_end(WindowEnd::display_lost, "");
    EXPECT_TRUE(exchange.wait_until_ended(1ms));
    EXPECT_EQ(exchange.end(), WindowEnd::display_lost);
}

}  // namespace
}  // namespace pogosim
