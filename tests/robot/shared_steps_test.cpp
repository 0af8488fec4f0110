// Robots that several workers run send, say and show what they do when one thread runs them all.
#include "robot/shared_steps.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/worker_pool.hpp"
#include "robot/context.hpp"
#include "sim/build_world.hpp"
#include "support/scenes.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

constexpr int kRobots = 700;
constexpr int kSteps = 12;

struct Outcome {
    std::vector<std::uint32_t> senders;
    std::vector<std::byte> payloads;
    std::vector<std::uint64_t> state;
    std::vector<std::string> last_lines;
    bool stop_requested = false;
    std::string failure;
    std::string place;  // of the failure

    friend bool operator==(Outcome const&, Outcome const&) = default;
};

/// A swarm with its programs, and nothing else of a simulation.
class Swarm {
public:
    Swarm() : handler_(code_of_robots(), nullptr, 10.0), thread_(handler_) { context.outbox = nullptr; }

    Outcome run(std::uint32_t threads) {
        // The program and the simulator are in one file here: only the test knows that robots share nothing.
        WorkerPool workers(threads);
        std::optional<SharedSteps> shared;
        EXPECT_FALSE(call_user_code([this] { controllers_.start(); }));
        if (threads > 1) {
            shared.emplace(controllers_, handler_, workers.size());
        }
        for (world_.step = 0; world_.step < kSteps; ++world_.step) {
            auto const failure =
                shared ? shared->run_step(workers) : call_user_code([this] { controllers_.run_step(); });
            if (failure) {
                outcome_.failure = failure->what;
                outcome_.place = current_place();
                break;
            }
            note_messages();
        }
        note_state();
        return outcome_;
    }

private:
    void note_messages() {
        for (Transmission const& transmission : world_.air.transmissions) {
            outcome_.senders.push_back(transmission.robot);
            std::span const payload = world_.air.payload_of(transmission);
            outcome_.payloads.insert(outcome_.payloads.end(), payload.begin(), payload.end());
        }
        world_.air.clear();
    }

    void note_state() {
        for (std::uint32_t i = 0; i < kRobots && outcome_.failure.empty(); ++i) {
            TestData data;
            std::memcpy(&data, controllers_.controller_of(i).user_data, sizeof(data));
            outcome_.state.insert(outcome_.state.end(), data.number.begin(), data.number.end());
            outcome_.state.push_back(world_.robots.led[i][0].r);
            outcome_.state.push_back(controllers_.ticks(i));
            for (std::string const& line : lines_.of(i)) {
                outcome_.last_lines.push_back(line);
            }
        }
        outcome_.stop_requested = services_.stop_requested;
    }

    Scenario scenario_ = testing::square_scene({testing::robots(kRobots)}, 4000.0);
    World world_ = build_world(scenario_, 1);
    PrintedLines lines_{kRobots};
    RunServices services_{.parameters = nullptr, .seed = 1, .data = {}, .warned = {}, .printed_lines = &lines_};
    CrashHandler handler_;
    CrashHandlerScope thread_;
    Controllers controllers_{testing::test_program(), world_, services_, 1, 1 << 20};
    Outcome outcome_;
};

void init() {
    srand(static_cast<unsigned>(pogobot_helper_getRandSeed()));
    percent_msgs_sent_per_ticks = 60;
    msg_tx_fn = [] {
        auto text = static_cast<std::uint8_t>(rand());
        pogobot_infrared_sendShortMessage_omni(&text, 1);
        return true;
    };
}

void step() {
    mydata->number[0] += rand() % 1000;
    pogobot_led_setColor(static_cast<std::uint8_t>(rand()), 0, 0);
    if (rand() % 50 == 0) {
        pogosim_printf("number %ld\n", static_cast<long>(mydata->number[0]));
    }
    if (rand() % 300 == 0) {
        message_t message;
        pogobot_infrared_recover_next_message(&message);  // a warning
    }
    if (rand() % 3000 == 0) {
        stop_simulation();
    }
}

TEST(SharedSteps, GiveTheSameWithAnyNumberOfWorkers) {
    testing::use_program(init, step);
    Outcome const expected = Swarm().run(1);
    EXPECT_EQ(expected.failure, "");
    EXPECT_TRUE(expected.stop_requested);
    EXPECT_GT(expected.senders.size(), 2000U);
    EXPECT_GT(expected.last_lines.size(), 50U);
    for (std::uint32_t const threads : {2U, 3U, 8U}) {
        EXPECT_EQ(Swarm().run(threads), expected) << threads;
    }
}

TEST(SharedStepsThat, FailNameTheFirstRobotThatDoes) {
    testing::use_program(init, [] {
        step();
        if (pogobot_ticks == 5 && pogobot_helper_getid() % 150 == 149) {
            exit(4);
        }
    });
    Outcome const expected = Swarm().run(1);
    EXPECT_EQ(expected.failure, "called exit(4)");
    EXPECT_NE(expected.place.find("robot #149 "), std::string::npos);
    for (std::uint32_t const threads : {2U, 3U, 8U}) {
        EXPECT_EQ(Swarm().run(threads), expected) << threads;
    }
}

}  // namespace
}  // namespace pogosim
