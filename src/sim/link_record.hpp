// Which links a run has had, for the metadata of its data file.
#pragma once

#include <cstddef>
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

}  // namespace pogosim
