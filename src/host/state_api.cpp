// Copies of the state of a run: pogosim_run_save_state() and so on of pogosim/host.h.
#include <memory>

#include "base/error.hpp"
#include "host/hosted_run.hpp"
#include "host/status.hpp"
#include "sim/saved_state.hpp"

using namespace pogosim;

struct pogosim_state {
    std::uint64_t run;  // its number
    std::unique_ptr<SavedState> saved;
};

namespace {

void must_go_on(pogosim_run const& run) {
    if (run.has_ended()) {
        throw ConfigError(run.has_failed() ? "the run has failed: reset it"
                                           : "the run has ended: reset it, or make another one");
    }
}

}  // namespace

int pogosim_run_save_state(pogosim_run* run, pogosim_state** state) {
    *state = nullptr;
    return with_status_of(*run, [&] {
        must_go_on(*run);
        *state = std::make_unique<pogosim_state>(pogosim_state{run->number, run->simulation().save()}).release();
        return POGOSIM_OK;
    });
}

int pogosim_run_restore_state(pogosim_run* run, pogosim_state const* state) {
    return with_status_of(*run, [&] {
        must_go_on(*run);
        if (state->run != run->number) {
            throw ConfigError("the state is that of another run, or of this simulation before a reset");
        }
        run->simulation().restore(*state->saved);
        return POGOSIM_OK;
    });
}

void pogosim_state_free(pogosim_state* state) {
    delete state;
}
