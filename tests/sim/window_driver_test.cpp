// Runs in a window that a script stands for, see window_script.hpp.
#include "sim/window_driver.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <thread>

#include "base/locked_file.hpp"
#include "base/log.hpp"
#include "sim/simulation.hpp"
#include "sim/window_script.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_program.hpp"

namespace pogosim::testing {

WindowScript window_script;

namespace {

using namespace std::chrono_literals;
using SharedMoment = std::shared_ptr<Moment const>;

void idle() {}

std::string content_of(std::filesystem::path const& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void full_ahead() {
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorFull);
}

/// Polls; a script that waits for too long fails.
template <class IsDone>
void wait_for(char const* what, IsDone const& is_done) {
    auto const end = Exchange::Clock::now() + 60s;
    while (!is_done()) {
        if (Exchange::Clock::now() > end) {
            throw std::runtime_error(what);
        }
        std::this_thread::sleep_for(1ms);
    }
}

SharedMoment next_moment(Exchange& exchange, MomentRequest const& request) {
    exchange.request(request);
    SharedMoment moment;
    wait_for("a moment", [&] {
        if (exchange.is_closing()) {
            throw std::runtime_error("a moment of a run that is over");
        }
        return (moment = exchange.take_moment()) != nullptr;
    });
    return moment;
}

/// A moment after the run has done what was sent so far.
SharedMoment look(Exchange& exchange, MomentRequest const& request = {}) {
    next_moment(exchange, request);  // the run may have looked for commands before, and for the request after that
    return next_moment(exchange, request);
}

template <class IsRight>
SharedMoment look_for(Exchange& exchange, char const* what, IsRight const& is_right,
                      MomentRequest const& request = {}) {
    SharedMoment moment;
    wait_for(what, [&] { return is_right(*(moment = look(exchange, request))); });
    return moment;
}

SharedMoment look_for_step(Exchange& exchange, std::int64_t step) {
    return look_for(exchange, "a step", [&](Moment const& moment) { return moment.snapshot.step >= step; });
}

class WindowDriver : public ::testing::Test {
protected:
    void SetUp() override {
        setenv("SDL_VIDEODRIVER", "dummy", 1);  // there is a display
        use_program(idle, full_ahead);
        scenario_.simulation_time_s = 1e5;
        scenario_.view.gui_speed_up = 0.0;
    }
    void TearDown() override {
        simulation_.reset();  // waits for the window's thread, which calls the script
        window_script = nullptr;
    }

    /// Runs to the end; the user ends the run when the script is over. What the script throws fails the test.
    ExitCode run_with(std::function<void(Exchange&)> const& script, RunOptions options = {}) {
        return run_until_end(
            [script](WindowSetup const&, Exchange& exchange) {
                script(exchange);
                exchange.send(Quit{});
                wait_for("the end", [&] { return exchange.is_closing(); });
                return WindowEnd::closed;
            },
            std::move(options));
    }

    ExitCode run_until_end(WindowScript const& script, RunOptions options = {}) {
        auto const is_shown = std::make_shared<std::atomic<bool>>(false);
        window_script = [is_shown, script](WindowSetup const& setup, Exchange& exchange) {
            *is_shown = true;
            try {
                return script(setup, exchange);
            } catch (std::exception const& error) {
                ADD_FAILURE() << "waited for " << error.what();
                exchange.send(Quit{});
                return WindowEnd::closed;
            }
        };
        options.window = true;
        simulation_ = std::make_unique<Simulation>(std::move(image_), scenario_, std::move(options));
        ExitCode const code = simulation_->run();
        // A short run may be over before the thread of its window calls the script.
        wait_for("the run's window", [&] { return is_shown->load(); });
        return code;
    }

    Scenario scenario_ = square_scene({robot_at({200, 500})});
    ProgramImage image_ = test_program();
    std::unique_ptr<Simulation> simulation_;
};

/// The time is a thousand years away.
constexpr double kAlmostStill = 1e-12;

void make_steps(Exchange& exchange, int count) {
    std::int64_t const start = look(exchange)->snapshot.step;
    for (int i = 0; i < count; ++i) {
        exchange.send(StepOnce{});
    }
    look_for_step(exchange, start + count);
}

TEST_F(WindowDriver, RunGoesBackAndOnFromThereAsItDidBefore) {
    // What user code keeps in this test program itself cannot be copied.
    ObjectSpec spec = article_robot();
    spec.robot->brain = ScriptSpec{.entries = {{.time_s = 0.0, .motors = {1023, 1000, std::nullopt}}}};
    scenario_.objects = {robot_at({200, 500}, spec)};
    image_ = ProgramImage();
    EXPECT_EQ(run_with([](Exchange& exchange) {
                  exchange.send(Pause{true});
                  std::vector<std::vector<Vec2>> places;
                  std::int64_t const start = look(exchange)->snapshot.step;
                  for (int i = 0; i < 60; ++i) {
                      make_steps(exchange, 1);
                      places.push_back(look(exchange)->snapshot.position_mm);
                  }
                  double const now_s = look(exchange)->snapshot.time_s;
                  SharedMoment moment = look(exchange);
                  EXPECT_EQ(moment->status.why_no_way_back, "");
                  EXPECT_LE(moment->status.earliest_s, moment->snapshot.time_s);
                  double const step_s = now_s / static_cast<double>(start + 60);
                  exchange.send(GoBack{static_cast<double>(start + 10) * step_s});
                  moment = look(exchange);
                  EXPECT_EQ(moment->snapshot.step, start + 10);
                  EXPECT_TRUE(moment->status.paused);
                  EXPECT_EQ(moment->snapshot.position_mm, places[9]);
                  for (int i = 10; i < 60; ++i) {
                      make_steps(exchange, 1);
                      EXPECT_EQ(look(exchange)->snapshot.position_mm, places[static_cast<std::size_t>(i)]);
                  }
              }),
              ExitCode::done);
}

TEST_F(WindowDriver, ClosingTheWindowEndsTheWayBackToALaterMomentAtOnce) {
    ObjectSpec spec = article_robot();
    spec.robot->brain = ScriptSpec{.entries = {{.time_s = 0.0, .motors = {1023, 1000, std::nullopt}}}};
    scenario_.objects = {robot_at({200, 500}, spec)};
    scenario_.view.history_s = 1e6;  // one state, of the beginning, is kept: the way leads to the end of the run
    image_ = ProgramImage();
    std::int64_t start = 0;
    EXPECT_EQ(run_with([&](Exchange& exchange) {
                  exchange.send(Pause{true});
                  start = look(exchange)->snapshot.step;
                  exchange.send(GoBack{scenario_.simulation_time_s});
                  exchange.send(Quit{});
              }),
              ExitCode::done);
    // Steps are made between the two requests, more on a busy machine; the end of the run is ten million of them away.
    EXPECT_LT(simulation_->world().step, start + 5'000'000);
}

TEST_F(WindowDriver, RunThatWritesADataFileSaysThatItCannotGoBack) {
    TemporaryFolder const folder;
    scenario_.output.enable_data_logging = true;
    scenario_.output.data_filename = (folder.path() / "run.feather").string();
    EXPECT_EQ(run_with([](Exchange& exchange) {
                  exchange.send(Pause{true});
                  make_steps(exchange, 3);
                  SharedMoment const moment = look(exchange);
                  EXPECT_EQ(moment->status.why_no_way_back, "it writes a data file (enable_data_logging: false)");
                  exchange.send(GoBack{0.0});
                  EXPECT_EQ(look(exchange)->snapshot.step, moment->snapshot.step);
              }),
              ExitCode::done);
}

TEST_F(WindowDriver, RunPausesWhenAConditionBecomesTrueOfARobot) {
    scenario_.view.pause_when = "x > 300";
    EXPECT_EQ(
        run_with([](Exchange& exchange) {
            SharedMoment moment = look_for(exchange, "the pause", [](Moment const& one) { return one.status.paused; });
            EXPECT_GT(moment->snapshot.position_mm[0].x, 300.0F);
            EXPECT_LT(moment->snapshot.position_mm[0].x, 310.0F);
            EXPECT_EQ(moment->status.why_paused.substr(0, 14), "robot 0: x = 3");
            exchange.send(Pause{false});  // it stays true: there is no other pause
            look_for(exchange, "the robot's way",
                     [](Moment const& one) { return one.snapshot.position_mm[0].x > 400.0F; });
            exchange.send(PauseWhen{"x > 1e9 or sped < 1"});
            moment = look_for(exchange, "the message",
                              [](Moment const& one) { return !one.status.wrong_condition.empty(); });
            EXPECT_NE(moment->status.wrong_condition.find("did you mean 'speed'?"), std::string::npos);
            exchange.send(PauseWhen{""});
            look_for(exchange, "no message", [](Moment const& one) { return one.status.wrong_condition.empty(); });
        }),
        ExitCode::done);
}

TEST_F(WindowDriver, PausedRunMakesTheStepsAskedForAndNoOther) {
    EXPECT_EQ(run_with([](Exchange& exchange) {
                  exchange.send(Pause{true});
                  SharedMoment moment = look(exchange);
                  EXPECT_TRUE(moment->status.paused);
                  std::int64_t const start = moment->snapshot.step;
                  EXPECT_EQ(look(exchange)->snapshot.step, start);
                  exchange.send(StepOnce{});
                  look_for_step(exchange, start + 1);
                  for (int i = 0; i < 3; ++i) {
                      exchange.send(StepOnce{});
                  }
                  look_for_step(exchange, start + 4);
                  for (int i = 0; i < 5; ++i) {
                      moment = look(exchange);
                      EXPECT_TRUE(moment->status.paused);
                      EXPECT_EQ(moment->snapshot.step, start + 4);
                  }
              }),
              ExitCode::done);
}

TEST_F(WindowDriver, RunGoesOnAfterAPauseAndAStepPausesItAgain) {
    run_with([](Exchange& exchange) {
        exchange.send(Pause{true});
        std::int64_t const start = look(exchange)->snapshot.step;
        exchange.send(Pause{false});
        EXPECT_FALSE(look_for_step(exchange, start + 50)->status.paused);
        exchange.send(StepOnce{});
        SharedMoment const paused =
            look_for(exchange, "a pause", [](Moment const& moment) { return moment.status.paused; });
        std::int64_t step = paused->snapshot.step;
        for (int i = 0; i < 5; ++i) {
            std::int64_t const next = look(exchange)->snapshot.step;
            EXPECT_LE(next, step + (i == 0 ? 1 : 0));  // the one that was asked for
            step = next;
        }
    });
}

/// User code that waits for the script.
struct Gate {
    std::atomic<bool> is_reached = false;
    std::atomic<bool> is_open = false;
};
Gate* gate = nullptr;

TEST_F(WindowDriver, PauseTakesBackTheStepsThatWereAskedFor) {
    Gate here;
    gate = &here;
    use_program(idle, [] {
        gate->is_reached = true;
        for (auto const end = Exchange::Clock::now() + 60s; !gate->is_open && Exchange::Clock::now() < end;) {
            std::this_thread::sleep_for(1ms);
        }
    });
    run_with([&](Exchange& exchange) {
        wait_for("user code", [&] { return here.is_reached.load(); });
        std::int64_t const step = simulation_->world().step;  // of which the run is in the middle
        for (int i = 0; i < 3; ++i) {
            exchange.send(StepOnce{});
        }
        exchange.send(Pause{true});
        here.is_open = true;
        for (int i = 0; i < 5; ++i) {
            EXPECT_EQ(look(exchange)->snapshot.step, step + 1);
        }
    });
}

TEST_F(WindowDriver, SpeedIsThatAskedForLast) {
    scenario_.view.gui_speed_up = kAlmostStill;
    scenario_.simulation_time_s = 1.0;
    EXPECT_EQ(run_until_end(
                  [](WindowSetup const& setup, Exchange& exchange) {
                      EXPECT_EQ(setup.speed_up, kAlmostStill);
                      EXPECT_EQ(look(exchange)->status.asked_speed_up, kAlmostStill);
                      exchange.send(SetSpeedUp{2.0 * kAlmostStill});
                      SharedMoment const moment = look(exchange);
                      EXPECT_EQ(moment->status.asked_speed_up, 2.0 * kAlmostStill);
                      EXPECT_EQ(moment->snapshot.step, 0);
                      exchange.send(SetSpeedUp{0.0});
                      wait_for("the end", [&] { return exchange.is_closing(); });
                      return WindowEnd::closed;
                  },
                  {.close_at_end = true}),
              ExitCode::done);
    EXPECT_NEAR(simulation_->world().time_s(), 1.0, 1e-9);
}

TEST_F(WindowDriver, RestoredRunHasTheSpeedAndThePauseOfTheOneBefore) {
    RunOptions options;
    WindowState before;
    before.paused = true;
    before.speed_up = 12.0;
    options.restarted = Restart{.seed = 1, .window = before};
    run_with(
        [](Exchange& exchange) {
            for (int i = 0; i < 3; ++i) {
                SharedMoment const moment = look(exchange);
                EXPECT_TRUE(moment->status.paused);
                EXPECT_EQ(moment->status.asked_speed_up, 12.0);
                EXPECT_EQ(moment->snapshot.step, 0);
            }
        },
        options);
}

TEST_F(WindowDriver, ObjectStaysInTheHandUntilItIsLetGo) {
    scenario_.view.gui_speed_up = kAlmostStill;
    run_with([](Exchange& exchange) {
        EXPECT_FALSE(look(exchange)->status.touched);
        exchange.send(DragObject{0, {500, 300}});
        exchange.send(SetSpeedUp{0.0});
        SharedMoment moment = look(exchange);
        for (int i = 0; i < 5; ++i) {
            EXPECT_TRUE(moment->status.touched);
            EXPECT_NEAR(moment->snapshot.position_mm[0].x, 500.0F, 0.1F);
            EXPECT_NEAR(moment->snapshot.position_mm[0].y, 300.0F, 0.1F);
            moment = look_for_step(exchange, moment->snapshot.step + 20);
        }
        exchange.send(DropObject{});
        look_for(exchange, "a robot that goes on",
                 [](Moment const& now) { return now.snapshot.position_mm[0].x > 600.0F; });
    });
}

TEST_F(WindowDriver, ClickCallsTheCallbackOfThatRobot) {
    scenario_.objects.push_back(robot_at({200, 200}));
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, idle, "robots");
        callback_robot_click = [] { pogobot_led_setColors(0, 25, 0, 0); };
    };
    run_with([](Exchange& exchange) {
        exchange.send(ClickRobot{1});
        SharedMoment const moment = look(exchange);
        EXPECT_EQ(moment->snapshot.led[0][0], Rgb{});
        EXPECT_EQ(moment->snapshot.led[1][0], (Rgb{0, 25, 0}));
        EXPECT_TRUE(moment->status.touched);
    });
}

TEST_F(WindowDriver, CallbackThatFailsEndsTheRun) {
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, idle, "robots");
        callback_robot_click = [] { std::abort(); };
    };
    EXPECT_EQ(run_until_end([](WindowSetup const&, Exchange& exchange) {
                  exchange.send(ClickRobot{0});
                  wait_for("the end", [&] { return exchange.is_closing(); });
                  return WindowEnd::closed;
              }),
              ExitCode::user_program);
}

TEST_F(WindowDriver, MomentHasThePartsThatWereAskedFor) {
    scenario_.view.gui_speed_up = kAlmostStill;
    scenario_.objects.push_back(robot_at({200, 560}));
    run_with([](Exchange& exchange) {
        SharedMoment moment = look(exchange);
        EXPECT_EQ(moment->snapshot.trails, nullptr);
        EXPECT_TRUE(moment->snapshot.links.empty());
        EXPECT_FALSE(moment->inspection);
        moment = look(exchange, {.parts = {.links = true}, .robot = 1});
        EXPECT_EQ(moment->snapshot.links.size(), 1U);
        ASSERT_TRUE(moment->inspection);
        EXPECT_EQ(moment->inspection->robot, 1U);
    });
}

TEST_F(WindowDriver, TrailsShowWhereRobotsHaveBeenBeforeTheyAreAskedFor) {
    scenario_.view.gui_speed_up = kAlmostStill;
    run_with([&](Exchange& exchange) {
        EXPECT_EQ(look(exchange)->snapshot.trails, nullptr);
        for (int i = 0; i < 40; ++i) {
            exchange.send(StepOnce{});
        }
        look_for_step(exchange, 40);
        // 1 mm a step, and 2 mm from one point to the next.
        Snapshot const after = look(exchange, {.parts = {.trails = true}})->snapshot;
        EXPECT_NEAR(static_cast<double>(after.trails->size(0)), 20.0, 2.0);
        EXPECT_LT(length(after.trails->point(0, 0).position_mm - after.position_mm[0]), 2.1F);
        EXPECT_NEAR(after.trails->point(0, after.trails->size(0) - 1).position_mm.x, 200.0F, 0.1F);
    });
}

TEST_F(WindowDriver, WindowStaysOpenWhenTheSimulatedTimeIsOverAndTheFilesAreComplete) {
    TemporaryFolder const folder;
    scenario_.simulation_time_s = 0.5;
    scenario_.output.enable_data_logging = true;
    scenario_.output.data_filename = folder / "data.feather";
    EXPECT_EQ(run_until_end([&](WindowSetup const&, Exchange& exchange) {
                  SharedMoment const moment =
                      look_for(exchange, "the end", [](Moment const& now) { return now.status.is_over; });
                  EXPECT_NEAR(moment->snapshot.time_s, 0.5, 1e-9);
                  LockedFile const free(folder / "data.feather");  // another run could write it
                  std::string const bytes = content_of(folder / "data.feather");
                  EXPECT_TRUE(bytes.ends_with("ARROW1"));
                  // Nothing brings it back to life.
                  exchange.send(Pause{false});
                  exchange.send(StepOnce{});
                  exchange.send(ClickRobot{0});
                  exchange.send(DragObject{0, {500, 300}});
                  EXPECT_EQ(look(exchange)->snapshot.position_mm, moment->snapshot.position_mm);
                  EXPECT_FALSE(look(exchange)->status.touched);
                  EXPECT_TRUE(look(exchange, {.parts = {}, .robot = 0})->inspection);
                  EXPECT_EQ(content_of(folder / "data.feather"), bytes);
                  exchange.send(Quit{});
                  wait_for("the closing", [&] { return exchange.is_closing(); });
                  return WindowEnd::closed;
              }),
              ExitCode::done);
    EXPECT_FALSE(simulation_->restart());
}

TEST_F(WindowDriver, RunThatIsOverCanBeRestarted) {
    scenario_.simulation_time_s = 0.1;
    run_until_end([&](WindowSetup const&, Exchange& exchange) {
        look_for(exchange, "the end", [](Moment const& now) { return now.status.is_over; });
        exchange.send(Restart{.seed = 9, .overwrite = true});
        wait_for("the closing", [&] { return exchange.is_closing(); });
        return WindowEnd::closed;
    });
    ASSERT_TRUE(simulation_->restart());
    EXPECT_EQ(simulation_->restart()->seed, 9U);
    EXPECT_TRUE(simulation_->restart()->overwrite);
}

TEST_F(WindowDriver, WindowOfARunForScriptsClosesAtTheEnd) {
    scenario_.simulation_time_s = 0.1;
    EXPECT_EQ(run_until_end(
                  [&](WindowSetup const&, Exchange& exchange) {
                      wait_for("the closing", [&] { return exchange.is_closing(); });
                      return WindowEnd::closed;
                  },
                  {.close_at_end = true}),
              ExitCode::done);
}

TEST_F(WindowDriver, RestartEndsTheRunAndIsHandedOn) {
    scenario_.view.gui_speed_up = kAlmostStill;
    EXPECT_EQ(run_until_end([](WindowSetup const&, Exchange& exchange) {
                  WindowState window;
                  window.column = 3;
                  exchange.send(Restart{.seed = 5, .window = window});
                  wait_for("the end", [&] { return exchange.is_closing(); });
                  return WindowEnd::closed;
              }),
              ExitCode::done);
    auto const restart = simulation_->restart();
    ASSERT_TRUE(restart);
    EXPECT_EQ(restart->seed, 5U);
    EXPECT_EQ(restart->window->column, 3U);
}

TEST_F(WindowDriver, ClosedWindowEndsTheRunWhichIsNotRestarted) {
    scenario_.view.gui_speed_up = kAlmostStill;
    EXPECT_EQ(run_until_end([](WindowSetup const&, Exchange&) { return WindowEnd::closed; }), ExitCode::done);
    EXPECT_EQ(simulation_->world().step, 0);
    EXPECT_FALSE(simulation_->restart());
}

TEST_F(WindowDriver, QuitIsLoggedWithItsTime) {
    scenario_.view.gui_speed_up = kAlmostStill;
    ::testing::internal::CaptureStdout();
    run_with([](Exchange& exchange) { exchange.send(Note{"a line of the help"}); });
    flush_logs();
    std::string const printed = ::testing::internal::GetCapturedStdout();
    EXPECT_NE(printed.find("a line of the help"), std::string::npos) << printed;
    EXPECT_NE(printed.find("ended at t = 0.0000 s of 100000 s by closing the window"), std::string::npos) << printed;
}

TEST_F(WindowDriver, RunGoesOnWithoutAWindowThatFailsOrLosesItsDisplay) {
    scenario_.view.gui_speed_up = kAlmostStill;
    scenario_.simulation_time_s = 1.0;
    for (auto const& [end, warning] :
         {std::pair{WindowEnd::failed, "the window failed at t = 0.0000 s: the script says so"},
          std::pair{WindowEnd::display_lost, "the display is gone at t = 0.0000 s"}}) {
        ::testing::internal::CaptureStderr();
        WindowEnd const how = end;
        EXPECT_EQ(run_until_end([how](WindowSetup const&, Exchange&) { return how; }), ExitCode::done);
        flush_logs();
        std::string const printed = ::testing::internal::GetCapturedStderr();
        EXPECT_NE(printed.find(warning), std::string::npos) << printed;
        EXPECT_NEAR(simulation_->world().time_s(), 1.0, 1e-9);
    }
}

}  // namespace
}  // namespace pogosim::testing
