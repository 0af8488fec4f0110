#include "robot/native_program.hpp"

#include <string>
#include <utility>

#include "base/log.hpp"

namespace pogosim {

bool NativeProgram::succeeds(std::optional<UserFailure> failure) {
    if (!failure) [[likely]] {
        return true;
    }
    failure_ = std::move(failure);
    return false;
}

bool NativeProgram::start() {
    return succeeds(call_user_code([this] { controllers_.start(); }));
}

bool NativeProgram::run_step() {
    return succeeds(shared_steps_ ? shared_steps_->run_step(workers_)
                                  : call_user_code([this] { controllers_.run_step(); }));
}

bool NativeProgram::stop() {
    return succeeds(call_user_code([this] {
        controllers_.end();
        controllers_.print_unfinished_lines();
    }));
}

namespace {

struct SavedProgram final : SavedBrain {
    explicit SavedProgram(Controllers::Saved state) : controllers(std::move(state)) {}
    std::size_t byte_count() const override { return controllers.byte_count(); }
    Controllers::Saved controllers;
};

}  // namespace

std::unique_ptr<SavedBrain> NativeProgram::save() {
    return std::make_unique<SavedProgram>(controllers_.save());
}

void NativeProgram::restore(SavedBrain const& saved) {
    controllers_.restore(static_cast<SavedProgram const&>(saved).controllers);
}

std::string NativeProgram::why_never_for_process() const {
    std::string const reason = controllers_.why_never_portable();
    return reason.empty() ? controllers_.why_state_is_elsewhere() : reason;
}

std::string NativeProgram::why_not_now_for_process() const {
    return controllers_.is_waiting_in_middle()
               ? "a robot waits in the middle of its program, on a stack that only this process has"
               : "";
}

void NativeProgram::share_steps(bool shares_nothing) {
    if (workers_.size() == 1) {
        return;
    }
    std::string const reason = shares_nothing ? "" : controllers_.why_one_after_the_other();
    if (!reason.empty()) {
        log().info("threads: {}; robots take their steps one after the other: {}", workers_.size(), reason);
        return;
    }
    log().info("threads: {}; robots take their steps on all of them", workers_.size());
    shared_steps_.emplace(controllers_, handler_, workers_.size());
}

}  // namespace pogosim
