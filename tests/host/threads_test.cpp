// Runs inside another process, through pogosim/host.h: run on several threads at once, each gives the same results as
// alone.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "pogosim/host.h"

namespace {

struct Talk {
    std::string program;
    std::string scene;
    std::string failure;  // of the program hosted.c, at tick 20; empty: none
    std::int64_t seed = 1;
};

struct Result {
    std::uint64_t hash = 0;
    std::int64_t steps = 0;
    int status = POGOSIM_OK;
    std::string error;
};

constexpr std::int64_t kSteps = 150;

std::string written(std::string const& name, std::string const& text) {
    std::string path = ::testing::TempDir() + std::to_string(getpid()) + name;  // tests run side by side
    std::ofstream(path) << text;
    return path;
}

std::string scene(int robots) {
    return "arena_file: arenas/disk.csv\narena_surface: 400000\nenable_data_logging: false\nsimulation_time: 60\n"
           "objects: {robots: {type: pogobot, nb: " +
           std::to_string(robots) + ", msg_success_rate: {type: static, rate: 0.7}}}\n";
}

Result result_of(Talk const& talk) {
    std::vector<std::string> settings;
    if (!talk.failure.empty()) {
        settings = {"parameters.fail_at_tick=20", "parameters.failure=" + talk.failure, "user_code_timeout=0.2"};
    }
    std::vector<char const*> texts;
    for (std::string const& setting : settings) {
        texts.push_back(setting.c_str());
    }
    pogosim_run_options const options{.program = talk.program.c_str(),
                                      .configuration = talk.scene.c_str(),
                                      .settings = texts.data(),
                                      .setting_count = texts.size(),
                                      .seed = talk.seed,
                                      .strict = 0};
    Result result;
    pogosim_run* run = nullptr;
    result.status = pogosim_run_open(&options, &run);
    while (result.status == POGOSIM_OK && result.steps < kSteps) {
        std::int64_t done = 0;
        result.status = pogosim_run_step(run, 1 + result.steps % 7, 10.0, &done);
        result.steps += done;
    }
    result.error = result.status > POGOSIM_OVER ? pogosim_host_error() : "";
    result.hash = run != nullptr ? pogosim_run_hash(run) : 0;
    pogosim_run_close(run);
    return result;
}

std::vector<Result> on_threads(std::vector<Talk> const& talks) {
    std::vector<Result> results(talks.size());
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < talks.size(); ++i) {
        threads.emplace_back([&, i] { results[i] = result_of(talks[i]); });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    return results;
}

}  // namespace

TEST(HostedRuns, OnThreadsGiveWhatEachGivesAlone) {
    std::string const few = written("host_few.yaml", scene(10));
    std::string const many = written("host_many.yaml", scene(40));
    std::vector<Talk> const talks{{POGOSIM_HOSTED, few, "", 1},
                                  {POGOSIM_HANABI, many, "", 2},
                                  {POGOSIM_HOSTED, many, "", 3},
                                  {POGOSIM_HANABI, few, "", 4}};
    std::vector<Result> const together = on_threads(talks);
    for (std::size_t i = 0; i < talks.size(); ++i) {
        Result const alone = result_of(talks[i]);
        EXPECT_EQ(alone.status, POGOSIM_OK) << alone.error;
        EXPECT_GE(alone.steps, kSteps);
        EXPECT_EQ(together[i].hash, alone.hash) << i;
        EXPECT_EQ(together[i].steps, alone.steps);
    }
}

TEST(HostedRuns, ReadsAreAnsweredBetweenTwoStepsOfAnotherThread) {
    std::string const few = written("host_few.yaml", scene(10));
    pogosim_run_options const options{.program = POGOSIM_HOSTED,
                                      .configuration = few.c_str(),
                                      .settings = nullptr,
                                      .setting_count = 0,
                                      .seed = 1,
                                      .strict = 0};
    pogosim_run* run = nullptr;
    ASSERT_EQ(pogosim_run_open(&options, &run), POGOSIM_OK) << pogosim_host_error();
    auto const number = [&](char const* name) {
        double value = -1.0;
        EXPECT_EQ(pogosim_run_number(run, name, &value), POGOSIM_OK);
        return value;
    };
    double const last = number("step_count");
    std::thread stepping([&] {
        std::int64_t done = 0;
        EXPECT_EQ(pogosim_run_step(run, 1'000'000, 1e6, &done), POGOSIM_OVER);
    });
    int answers = 0;
    double before = 0.0;
    for (double now = 0.0; now < last; now = number("step")) {
        EXPECT_GE(now, before);
        answers += now > before ? 1 : 0;
        before = now;
        EXPECT_NE(pogosim_run_hash(run), 0U);
    }
    stepping.join();
    EXPECT_GE(answers, 1);
    EXPECT_EQ(number("is_over"), 1.0);
    EXPECT_EQ(number("has_failed"), 0.0);
    pogosim_run_close(run);
}

TEST(HostedRuns, FailuresOnThreadsEndTheirRunsAlone) {
    std::string const few = written("host_few.yaml", scene(10));
    std::vector<Talk> const talks{{POGOSIM_HOSTED, few, "crash", 1},
                                  {POGOSIM_HOSTED, few, "", 2},
                                  {POGOSIM_HOSTED, few, "loop", 3},
                                  {POGOSIM_HOSTED, few, "exit", 4}};
    std::vector<Result> const results = on_threads(talks);
    EXPECT_EQ(results[0].status, POGOSIM_PROGRAM_FAILED);
    EXPECT_NE(results[0].error.find("robot #1"), std::string::npos) << results[0].error;
    EXPECT_EQ(results[1].status, POGOSIM_OK) << results[1].error;
    EXPECT_EQ(results[2].status, POGOSIM_PROGRAM_FAILED);
    EXPECT_NE(results[2].error.find("did not return"), std::string::npos) << results[2].error;
    EXPECT_NE(results[3].status, POGOSIM_OK);
    EXPECT_EQ(results[1].hash, result_of(talks[1]).hash);
}
