// What an earlier run has written under the names of this one: kept beside it, under names with a number.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/scenario.hpp"

namespace pogosim {

struct KeptFile {
    std::filesystem::path path;  // a file, or the folder of frames
    std::filesystem::path
        kept;  // "run.1.feather" beside "run.feather", "frames.1" beside "frames": the first free name
};

/// The data file, the message log and the film (--video) if they exist, and the folder of frames if there are some.
/// Frames whose folder depends on the time are not looked for.
std::vector<KeptFile> earlier_files(Scenario const& scenario, std::string const& film);

/// Renames them; no file is ever replaced. Frames move to a new folder, other files stay. What another run is writing,
/// and what the system does not let us rename, stays: the run will say so. Returns those that were renamed, with the
/// names that they have got.
std::vector<KeptFile> keep_earlier_files(Scenario const& scenario, std::string const& film);

}  // namespace pogosim
