// The program in C as a brain: of all robots whose category says nothing else.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/worker_pool.hpp"
#include "brain/brain.hpp"
#include "process/crash_handler.hpp"
#include "robot/controllers.hpp"
#include "robot/shared_steps.hpp"

namespace pogosim {

class NativeProgram final : public Brain {
public:
    /// All of these outlive this.
    NativeProgram(Controllers& controllers, CrashHandler& handler, WorkerPool& workers)
        : controllers_(controllers), handler_(handler), workers_(workers) {}

    /// main(), callback_global_setup and user_init of all robots.
    bool start() override;

    /// callback_global_step, then the robots.
    bool run_step() override;

    /// callback_robot_end of all robots, and the last lines that they print.
    bool stop() override;

    /// From now on, robots take their steps on all workers if the program lets them. `shares_nothing`: it does,
    /// whatever can be read of it.
    void share_steps(bool shares_nothing);

    std::optional<UserFailure> failure() const override { return failure_; }

    // Its state is hashed by state_hash(): it contains addresses, which differ from process to process.
    std::unique_ptr<SavedBrain> save() override;
    void restore(SavedBrain const& saved) override;
    std::string why_not_saved() const override { return controllers_.why_not_saved(); }
    void append_for_process(StateWriter& state) override { controllers_.append_state(state); }
    void take_from_process(StateReader& state) override { controllers_.take_state(state); }
    std::string why_never_for_process() const override;
    std::string why_not_now_for_process() const override;

private:
    bool succeeds(std::optional<UserFailure> failure);

    Controllers& controllers_;
    CrashHandler& handler_;
    WorkerPool& workers_;
    std::optional<SharedSteps> shared_steps_;  // when robots may run on several threads
    std::optional<UserFailure> failure_;
};

}  // namespace pogosim
