// The steps of robots that share nothing, on several threads: each takes a part of the swarm.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/worker_pool.hpp"
#include "process/crash_handler.hpp"
#include "robot/controllers.hpp"
#include "robot/outbox.hpp"
#include "robot/shared_state.hpp"

namespace pogosim {

class SharedSteps {
public:
    /// For robots about which why_one_after_the_other() finds nothing. `workers` have ended when this is destroyed.
    SharedSteps(Controllers& controllers, CrashHandler& handler, std::uint32_t workers);

    /// As Controllers::run_step() inside call_user_code(): the same robots send, say and fail, however many workers
    /// there are. When several robots fail, it is the failure of the first one.
    std::optional<UserFailure> run_step(WorkerPool& workers);

private:
    struct Part {
        Outbox outbox;
        std::optional<UserFailure> failure;
        RunningRobot failed;
        Controllers::Callbacks callbacks;  // as its robots have left them
    };

    std::optional<UserFailure> run_one_after_the_other();

    void run_part(WorkRange range);
    std::optional<UserFailure> join(Part& part);
    std::optional<UserFailure> look_at_variables();

    Controllers& controllers_;
    ConfiguredVariables variables_;
    std::vector<std::unique_ptr<WorkerCrashHandler>>
        handlers_;  // of each worker but the first, whose handler is that of the run
    std::vector<Part> parts_;
    Controllers::Callbacks callbacks_;             // before the robots' steps
    bool is_over_ = false;                         // they may share memory now
    std::atomic<std::uint32_t> first_failed_ = 0;  // of the parts; kNone: none has failed
};

}  // namespace pogosim
