// Runs inside another process, through pogosim/host.h: run on several threads at once, each gives the same results as
// alone.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "pogosim/host.h"

namespace {

struct Talk {
    std::string program;  // empty: the configuration needs none
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

int open_run(Talk const& talk, pogosim_run** run) {
    std::vector<std::string> settings;
    if (!talk.failure.empty()) {
        settings = {"parameters.fail_at_tick=20", "parameters.failure=" + talk.failure, "user_code_timeout=0.2"};
    }
    std::vector<char const*> texts;
    for (std::string const& setting : settings) {
        texts.push_back(setting.c_str());
    }
    pogosim_run_options const options{.program = talk.program.empty() ? nullptr : talk.program.c_str(),
                                      .configuration = talk.scene.c_str(),
                                      .settings = texts.data(),
                                      .setting_count = texts.size(),
                                      .seed = talk.seed,
                                      .strict = 0,
                                      .strict_settings = 0};
    return pogosim_run_open(&options, run);
}

Result result_of(Talk const& talk) {
    Result result;
    pogosim_run* run = nullptr;
    result.status = open_run(talk, &run);
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

/// Runs that are closed at the end.
class OpenRuns {
public:
    explicit OpenRuns(std::vector<Talk> const& talks) : all_(talks.size(), nullptr) {
        for (std::size_t i = 0; i < talks.size(); ++i) {
            EXPECT_EQ(open_run(talks[i], &all_[i]), POGOSIM_OK) << pogosim_host_error();
        }
    }
    ~OpenRuns() {
        for (pogosim_run* const run : all_) {
            pogosim_run_close(run);
        }
    }
    OpenRuns(OpenRuns const&) = delete;
    OpenRuns& operator=(OpenRuns const&) = delete;

    pogosim_run* const* data() const { return all_.data(); }
    std::size_t size() const { return all_.size(); }
    pogosim_run* operator[](std::size_t i) const { return all_[i]; }

private:
    std::vector<pogosim_run*> all_;
};

/// Lets all runs make so many steps. Returns what each has done.
std::vector<pogosim_turn> stepped(OpenRuns const& runs, pogosim_threads* threads, std::int64_t steps,
                                  std::vector<pogosim_exchange> const& exchanges = {}) {
    std::vector<pogosim_turn> turns(runs.size(), {.left = steps, .status = POGOSIM_OK, .has_messages = 0});
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    pogosim_threads_step(threads, runs.data(), turns.data(), turns.size(), exchanges.data(), exchanges.size(),
                         kNoLimit);
    return turns;
}

}  // namespace

TEST(ManyRuns, OnThreadsOfTheLibraryGiveWhatEachGivesAlone) {
    std::string const few = written("host_few.yaml", scene(10));
    std::vector<Talk> talks;
    for (std::int64_t seed = 1; seed <= 7; ++seed) {
        talks.push_back({seed % 2 == 0 ? POGOSIM_HANABI : POGOSIM_HOSTED, few, "", seed});
    }
    for (int const count : {1, 2, 5, 20}) {
        OpenRuns const runs(talks);
        pogosim_threads* threads = nullptr;
        ASSERT_EQ(pogosim_threads_open(count, &threads), POGOSIM_OK);
        for (std::int64_t steps = 0, each = 0; steps < kSteps; steps += each) {
            each = 1 + steps % 7;  // as result_of()
            for (pogosim_turn const& turn : stepped(runs, threads, each)) {
                EXPECT_EQ(turn.left, 0);
                EXPECT_EQ(turn.status, POGOSIM_OK);
            }
        }
        pogosim_threads_close(threads);
        for (std::size_t i = 0; i < talks.size(); ++i) {
            EXPECT_EQ(pogosim_run_hash(runs[i]), result_of(talks[i]).hash) << i << " of " << count;
        }
    }
}

TEST(ManyRuns, FailuresEndTheirRunsAlone) {
    std::string const few = written("host_few.yaml", scene(10));
    std::vector<Talk> const talks{{POGOSIM_HOSTED, few, "", 2},
                                  {POGOSIM_HOSTED, few, "crash", 1},
                                  {POGOSIM_HOSTED, few, "loop", 3},
                                  {POGOSIM_HOSTED, few, "", 5},
                                  {POGOSIM_HOSTED, few, "exit", 4}};
    for (int const count : {1, 3}) {
        OpenRuns const runs(talks);
        pogosim_threads* threads = nullptr;
        ASSERT_EQ(pogosim_threads_open(count, &threads), POGOSIM_OK);
        std::vector<pogosim_turn> const turns = stepped(runs, threads, kSteps);
        EXPECT_NE(std::string(pogosim_host_error()).find("robot #1"), std::string::npos) << pogosim_host_error();
        EXPECT_NE(std::string(pogosim_threads_error(threads, 2)).find("did not return"), std::string::npos);
        EXPECT_STREQ(pogosim_threads_error(threads, 0), "");
        EXPECT_STREQ(pogosim_threads_error(threads, 99), "");
        EXPECT_EQ(turns[0].status, POGOSIM_OK);
        EXPECT_EQ(turns[1].status, POGOSIM_PROGRAM_FAILED);
        EXPECT_EQ(turns[2].status, POGOSIM_PROGRAM_FAILED);
        EXPECT_EQ(turns[3].left, 0);
        EXPECT_EQ(stepped(runs, threads, 1)[1].status, POGOSIM_USAGE);  // it has failed before
        EXPECT_STREQ(pogosim_threads_error(threads, 1), "the run has failed: reset it");
        pogosim_threads_close(threads);
    }
}

TEST(ManyRuns, LeaveSignalsToTheProcess) {
    auto const other = [](int /*signal*/) {};
    for (int const signal : {SIGSEGV, SIGPROF, SIGALRM}) {
        std::signal(signal, other);
    }
    OpenRuns const runs({{POGOSIM_HANABI, written("host_few.yaml", scene(10)), "", 1}});
    pogosim_threads* threads = nullptr;
    ASSERT_EQ(pogosim_threads_open(2, &threads), POGOSIM_OK);
    stepped(runs, threads, 20);
    std::this_thread::sleep_for(std::chrono::seconds(3));  // they stay for a further step
    for (int const signal : {SIGSEGV, SIGPROF, SIGALRM}) {
        struct sigaction now = {};
        sigaction(signal, nullptr, &now);
        EXPECT_EQ(now.sa_handler, static_cast<void (*)(int)>(other));
        std::signal(signal, SIG_DFL);
    }
    pogosim_threads_close(threads);
}

TEST(ManyRuns, GiveTheirArraysOneAfterTheOther) {
    OpenRuns const runs({{POGOSIM_HANABI, written("host_few.yaml", scene(10)), "", 1},
                         {POGOSIM_HANABI, written("host_few.yaml", scene(10)), "", 2},
                         {POGOSIM_HANABI, written("host_many.yaml", scene(40)), "", 3}});
    std::array<std::array<float, 20>, 2> places{};
    ASSERT_EQ(pogosim_runs_read(runs.data(), 2, nullptr, "bodies.position", places.data(), sizeof(places[0])),
              POGOSIM_OK);
    for (std::size_t i = 0; i < 2; ++i) {
        pogosim_array own = {};
        ASSERT_EQ(pogosim_run_array(runs[i], "bodies.position", &own), POGOSIM_OK);
        EXPECT_EQ(std::memcmp(own.data, places.at(i).data(), sizeof(places[0])), 0);
    }
    std::array<std::byte, 3 * sizeof(places[0])> room{};
    auto const read = [&](char const* category, char const* name) {
        return pogosim_runs_read(runs.data(), 3, category, name, room.data(), sizeof(places[0]));
    };
    EXPECT_EQ(read(nullptr, "bodies.position"), POGOSIM_USAGE);
    EXPECT_STREQ(pogosim_host_error(), "run 2: the array has 40 rows of 8 bytes, and there is room for 80 bytes");
    EXPECT_EQ(read(nullptr, "bodies.colour"), POGOSIM_USAGE);
    EXPECT_STREQ(pogosim_host_error(), "a run has no array 'bodies.colour'");
    EXPECT_EQ(read("robots", "motors"), POGOSIM_USAGE);
}

TEST(ManyRuns, ExchangeArraysWithTheHostAroundTheirSteps) {
    std::string driven = scene(3);
    driven.insert(driven.find("nb:"), "brain: host, ");
    std::string const file = written("host_driven.yaml", driven);
    OpenRuns const runs({{"", file, "", 1}, {"", file, "", 2}});
    pogosim_threads* threads = nullptr;
    ASSERT_EQ(pogosim_threads_open(2, &threads), POGOSIM_OK);

    std::array<std::array<std::int32_t, 9>, 2> motors{{{1, 2, 3, 4, 5, 6, 7, 8, 9}, {9, 8, 7, 6, 5, 4, 3, 2, 1}}};
    std::array<std::array<std::int32_t, 3>, 2> lengths{};  // messages of 0 bytes
    std::array<std::array<std::int16_t, 3>, 2> voltages{};
    auto const given = motors;
    std::vector<pogosim_exchange> exchanges{{"robots", "motors", motors.data(), sizeof(motors[0]), 1, 0},
                                            {"robots", "send_length", lengths.data(), sizeof(lengths[0]), 1, 1},
                                            {"robots", "battery_mv", voltages.data(), sizeof(voltages[0]), 0, 1}};
    stepped(runs, threads, 0, exchanges);
    EXPECT_EQ(lengths[1][2], 0);
    for (std::size_t i = 0; i < 2; ++i) {
        pogosim_array own = {};
        ASSERT_EQ(pogosim_run_brain_array(runs[i], "robots", "motors", &own), POGOSIM_OK);
        EXPECT_EQ(std::memcmp(own.data, given.at(i).data(), sizeof(given[0])), 0);
    }
    stepped(runs, threads, 3, exchanges);
    EXPECT_EQ(motors, given);
    EXPECT_EQ(lengths[1][2], -1);  // sent
    EXPECT_GT(voltages[1][2], 3000);

    exchanges = {{"robots", "battery_mv", voltages.data(), sizeof(voltages[0]), 1, 0}};
    EXPECT_EQ(stepped(runs, threads, 1, exchanges)[1].status, POGOSIM_USAGE);
    EXPECT_STREQ(pogosim_threads_error(threads, 1), "the array 'battery_mv' cannot be written");
    exchanges = {{"robots", "motors", motors.data(), 8, 1, 0}};
    EXPECT_EQ(stepped(runs, threads, 1, exchanges)[1].left, 1);
    EXPECT_STREQ(pogosim_threads_error(threads, 1),
                 "run 1: the array has 3 rows of 12 bytes, and there is room for 8 bytes");
    pogosim_threads_close(threads);
}

TEST(ManyRuns, NeedASensibleNumberOfThreads) {
    for (int const count : {-1, 0, 1025}) {
        pogosim_threads* threads = nullptr;
        EXPECT_EQ(pogosim_threads_open(count, &threads), POGOSIM_USAGE);
        EXPECT_EQ(threads, nullptr);
    }
    pogosim_threads_close(nullptr);
}

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
                                      .strict = 0,
                                      .strict_settings = 0};
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
