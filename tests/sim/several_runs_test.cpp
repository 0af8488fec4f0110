// Several runs in one process.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "process/caught_signals.hpp"
#include "process/crash_message.hpp"
#include "sim/interrupt.hpp"
#include "support/scenes.hpp"
#include "support/test_program.hpp"

namespace pogosim::testing {

namespace {

Scenario short_scene(std::string const& data_file = "") {
    Scenario scenario = square_scene({robot_at({500, 500})});
    scenario.simulation_time_s = 1.0;
    scenario.output.enable_data_logging = !data_file.empty();
    scenario.output.data_filename = data_file;
    return scenario;
}

ExitCode run_once(Scenario const& scenario, void (*step)()) {
    use_program([] {}, step);
    Simulation simulation(test_program(), scenario, RunOptions{});
    ProcessRun const for_signals(simulation.crash_handler());
    return simulation.run();
}

void crash() {
    if (pogobot_ticks == 10) {
        std::abort();
    }
}

}  // namespace

TEST(SeveralRuns, CrashInEachEndsThatRunAlone) {
    std::string const path = ::testing::TempDir() + "several_runs.feather";
    for (int i = 0; i < 3; ++i) {
        std::filesystem::remove(path);
        EXPECT_EQ(run_once(short_scene(path), crash), ExitCode::user_program);
        EXPECT_GT(std::filesystem::file_size(path), 0U);
    }
    EXPECT_EQ(run_once(short_scene(), [] {}), ExitCode::done);
    std::filesystem::remove(path);
}

TEST(SeveralRuns, SignalEndsTheRunInWhichItComesAndNoLaterOne) {
    catch_interrupts();
    EXPECT_EQ(run_once(short_scene(), [] { std::raise(SIGTERM); }), ExitCode::interrupted);
    EXPECT_EQ(run_once(short_scene(), [] {}), ExitCode::done);
    release_caught_signals();
}

TEST(SeveralRuns, LastWordsOfOneWithoutDataNameNoEarlierFile) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // a child of fork() would end quietly
    std::string const path = ::testing::TempDir() + "earlier_run.feather";
    EXPECT_EQ(run_once(short_scene(path), [] {}), ExitCode::done);
    auto const die = [] {
        prepare_crash_message("all is lost", /*in_other_thread=*/false);
        end_with_crash_message(3);
    };
    EXPECT_EXIT(run_once(short_scene(), die), ::testing::ExitedWithCode(3), "all is lost\\. If the program");
    std::filesystem::remove(path);
}

}  // namespace pogosim::testing
