// The state of the user's program on all robots, to go on from it later in the same process: variables, user data, the
// stacks of robots that wait in the middle, and what the simulator keeps for each.
#include <fmt/format.h>

#include <algorithm>

#include "process/program_memory.hpp"
#include "robot/controllers.hpp"
#include "robot/shared_state.hpp"

namespace pogosim {

namespace {

std::vector<std::byte> bytes_in(std::span<std::span<std::byte> const> pieces) {
    std::vector<std::byte> bytes;
    for (std::span<std::byte> const piece : pieces) {
        bytes.resize(bytes.size() + piece.size());
        copy_program_bytes(bytes.data() + bytes.size() - piece.size(), piece.data(), piece.size());
    }
    return bytes;
}

void put_into(std::span<std::span<std::byte> const> pieces, std::byte const* from) {
    for (std::span<std::byte> const piece : pieces) {
        copy_program_bytes(piece.data(), from, piece.size());
        from += piece.size();
    }
}

}  // namespace

Controllers::Saved Controllers::save() {
    Saved saved{.controllers = controllers_,
                .system = system_,
                .callbacks = callbacks_,
                .user_data = bytes_in({&services_.user_data, 1}),
                .variables = {},
                .own_memory = std::nullopt,
                .fibers = fibers_.save(),
                .columns = services_.data,
                .bound_variables = services_.bound_variables,
                .is_restart_due = is_restart_due_,
                .gave_user_data = services_.gave_user_data};
    if (own_memory_) {
        saved.own_memory = own_memory_->save_all();
    }
    saved.variables = bytes_in(image_.variables);
    return saved;
}

std::size_t Controllers::Saved::byte_count() const {
    std::size_t bytes = controllers.size() * sizeof(Controller) + user_data.size() + variables.size();
    if (own_memory) {
        bytes += own_memory->same.size() + own_memory->other.size() + own_memory->copies.size() +
                 own_memory->different.size() * sizeof(own_memory->different[0]) +
                 own_memory->changed.size() * sizeof(own_memory->changed[0]);
    }
    for (SavedFiber const& fiber : fibers) {
        bytes += fiber.stack.size();
    }
    return bytes;
}

void Controllers::restore(Saved const& saved) {
    controllers_ = saved.controllers;
    system_ = saved.system;
    callbacks_ = saved.callbacks;
    put_into({&services_.user_data, 1}, saved.user_data.data());
    if (own_memory_ && saved.own_memory) {
        own_memory_->restore_all(*saved.own_memory);
    }
    put_into(image_.variables, saved.variables.data());
    fibers_.restore(saved.fibers);
    services_.data = saved.columns;
    services_.bound_variables = saved.bound_variables;
    is_restart_due_ = saved.is_restart_due;
    services_.gave_user_data = saved.gave_user_data;
    next_look_us_ = 0;
}

std::string Controllers::why_not_saved() const {
    if (!why_not_saved_) {
        why_not_saved_ = why_state_is_not_copied(image_);
        calls_back_ = image_.main != nullptr ? function_that_calls_back(image_) : "";
    }
    // It may wait in a comparison of qsort(), whose copy of the values is on the heap.
    bool const waits = std::ranges::any_of(controllers_, [](Controller const& self) { return self.fiber != nullptr; });
    if (why_not_saved_->empty() && waits && !calls_back_.empty()) {
        return fmt::format(
            "a robot waits in the middle of a program that uses '{}', which may keep values in memory "
            "that is not copied: save when none waits",
            calls_back_);
    }
    return *why_not_saved_;
}

}  // namespace pogosim
