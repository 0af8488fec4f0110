// Functions of a program in C that take time of the robot's clock: cpu_time: counted with function_costs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "support/scenes.hpp"
#include "support/test_program.hpp"

// Functions with a name, as those of a program.
extern "C" {

static void timed_step() {}

static void timed_receive(message_t* /*message*/) {}

static bool timed_send() {
    std::array<std::uint8_t, 1> bytes{};
    pogobot_infrared_sendShortMessage_omni(bytes.data(), bytes.size());
    return true;
}
}

namespace pogosim {
namespace {

constexpr double kCyclesPerMs = 21000.0;

ObjectSpec timed_robot(std::vector<FunctionCost> costs, double cycle_factor = 1.0) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->cpu_time = CpuTime::counted;
    spec.robot->model.processor.cycle_factor = cycle_factor;
    spec.robot->function_costs = std::move(costs);
    return spec;
}

/// Ticks per second of a robot over 20 s.
double ticks_per_second(ObjectSpec const& spec, void (*init)() = nullptr) {
    constexpr double seconds = 20.0;
    testing::use_program(init, timed_step);
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(1, spec)}), RunOptions{});
    EXPECT_FALSE(simulation.start());
    EXPECT_FALSE(testing::run_for(simulation, seconds));
    return simulation.controllers().ticks(0) / seconds;
}

/// The time from tick to tick at 60 Hz: a tick sleeps the whole milliseconds that are left of it, if any.
double tick_ms(double step_ms) {
    constexpr double allowed_ms = 16.666;
    return step_ms + std::max(0.0, std::floor(allowed_ms - step_ms));
}

TEST(FunctionTimes, TickTakesWhatItsStepTakes) {
    for (double const ms : {0.0, 0.9, 5.0, 16.0, 17.0, 25.5, 100.0}) {
        ObjectSpec const spec = timed_robot({{.function = "timed_step", .cycles = ms * kCyclesPerMs}});
        EXPECT_NEAR(ticks_per_second(spec), 1000.0 / tick_ms(ms), 0.2) << ms << " ms";
    }
}

TEST(FunctionTimes, CyclesAreMultipliedAndLibraryTimeIsNot) {
    FunctionCost const cost{.function = "timed_step", .cycles = 10.0 * kCyclesPerMs, .library_us = 5000.0};
    EXPECT_NEAR(ticks_per_second(timed_robot({cost}, 3.0)), 1000.0 / 35.0, 0.2);
}

TEST(FunctionTimes, MainLoopHasCostsOfItsOwn) {
    FunctionCost const step{.function = "timed_step", .cycles = 20.0 * kCyclesPerMs};
    FunctionCost const loop{.function = "pogo_main_loop_step", .cycles = 10.0 * kCyclesPerMs};
    EXPECT_NEAR(ticks_per_second(timed_robot({step, loop})), 1000.0 / 30.0, 0.2);
}

TEST(FunctionTimes, FractionsOfMicrosecondsAddUp) {
    // Each tick takes a quarter of a microsecond more: 0.25 us x 1000 ticks.
    FunctionCost const cost{.function = "timed_step", .library_us = 1000.25};
    testing::use_program(nullptr, timed_step);
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(1, timed_robot({cost}))}),
                          RunOptions{});
    ASSERT_FALSE(simulation.start());
    while (simulation.controllers().ticks(0) < 1000) {
        ASSERT_FALSE(simulation.step());
    }
    // Each sleeps 15 ms: 16 666 us less the 1000 us that the clock shows.
    EXPECT_EQ(simulation.world().devices.clock_us[0], 1000 * 16000 + 250);
}

TEST(FunctionTimes, MessagesTakeTimeWhenTheyAreSentAndReceived) {
    auto const init = [] {
        msg_tx_fn = timed_send;
        msg_rx_fn = timed_receive;
        percent_msgs_sent_per_ticks = 100;
    };
    testing::use_program(init, timed_step);
    ObjectSpec const spec = timed_robot({{.function = "timed_send", .cycles = 10.0 * kCyclesPerMs},
                                         {.function = "timed_receive", .cycles = 20.0 * kCyclesPerMs},
                                         {.function = "timed_step"}});
    Simulation simulation(
        testing::test_program(),
        testing::square_scene({testing::robot_at({400, 500}, spec), testing::robot_at({470, 500}, spec)}),
        RunOptions{});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 30.0));
    // Each tick sends one message, and takes the one that the other robot has sent since.
    EXPECT_NEAR(simulation.controllers().ticks(0) / 30.0, 1000.0 / 30.0, 0.5);
    EXPECT_NEAR(simulation.controllers().ticks(1) / 30.0, 1000.0 / 30.0, 0.5);
}

TEST(FunctionTimes, LateTickIsShown) {
    testing::use_program([] { error_codes_led_idx = 3; }, timed_step);
    ObjectSpec const spec = timed_robot({{.function = "timed_step", .cycles = 30.0 * kCyclesPerMs}});
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(1, spec)}), RunOptions{});
    ASSERT_FALSE(simulation.start());
    Rgb const before = simulation.world().robots.led[0][3];
    ASSERT_FALSE(testing::run_for(simulation, 0.5));
    EXPECT_NE(simulation.world().robots.led[0][3], before);
}

TEST(FunctionTimes, NothingTakesTimeUnlessItIsCounted) {
    ObjectSpec spec = timed_robot({{.function = "timed_step", .cycles = 100.0 * kCyclesPerMs}});
    spec.robot->cpu_time = CpuTime::off;
    EXPECT_NEAR(ticks_per_second(spec), 62.5, 0.1);
}

TEST(FunctionTimes, UnknownNamesAndFunctionsWithoutCostsAreTold) {
    ::testing::internal::CaptureStderr();
    {
        testing::use_program(nullptr, timed_step);
        ObjectSpec const spec = timed_robot({{.function = "timed_stop", .cycles = 1.0}});
        Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(1, spec)}), RunOptions{});
        ASSERT_FALSE(simulation.start());
        ASSERT_FALSE(testing::run_for(simulation, 0.5));
        simulation.controllers().tell_at_end(0);
    }
    std::string const said = ::testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("objects.robots.function_costs: the program has no function 'timed_stop'; did you mean "
                        "'timed_step'?"),
              std::string::npos)
        << said;
    EXPECT_NE(said.find("objects.robots.function_costs say nothing of timed_step, which the main loop has called"),
              std::string::npos)
        << said;
}

}  // namespace
}  // namespace pogosim
