// How the links of a run change: which broke, for users, and all of them, for the metadata of its data file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

class LinkRecord {
public:
    /// The links at the start of the run, as JSON, which docs/data_file.md describes. Empty: there are none.
    static std::string initial(World const& world);

    /// Notes the links that were made and cut since the last call. Call it at the start, and after each step.
    void follow(World const& world);

    /// What follow() has noted since its first call, as JSON. Empty: nothing.
    std::string changes(World const& world) const;

    /// See state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.has_begun_, self.initial_count_, self.made_s_, self.cut_, self.is_cut_);
    }

private:
    struct Cut {
        std::size_t link = 0;
        double time_s = 0.0;
    };

    bool has_begun_ = false;
    std::size_t initial_count_ = 0;
    std::vector<double> made_s_;  // of the links after the initial ones
    std::vector<Cut> cut_;        // in the order of time
    std::vector<bool> is_cut_;    // what is in `cut_`, by link
};

// Tells users that links have broken.

class BrokenLinks {
public:
    /// Before the step of the engine: what is cut now was cut by a program or a host.
    void note(World const& world);

    /// After it: what has been cut in it has broken. Logs the first link of each category that does.
    void tell(World const& world);

    /// See state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.changes_, self.is_cut_, self.has_broken_);
    }

private:
    std::uint32_t changes_ = 0;     // World::link_changes when links were last looked at
    std::vector<bool> is_cut_;      // each link
    std::vector<bool> has_broken_;  // each category
};

}  // namespace pogosim
