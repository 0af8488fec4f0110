// Files that an earlier run has written under the names of this one: they are kept under numbered names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/scenario.hpp"

namespace pogosim {

struct KeptFile {
    std::filesystem::path path;  // a file, or the folder of frames
    // "run.1.feather" beside "run.feather", "frames.1" beside "frames": the first free name
    std::filesystem::path kept;
    std::vector<std::filesystem::path> moved{};  // the frames, where they were
};

/// The data file, the message log, the film (--video) and the archive of flash memory if they exist (but no archive
/// that is read, too), and the folder of frames if there are some. Frames whose folder depends on the time are not
/// looked for.
std::vector<KeptFile> earlier_files(Scenario const& scenario, std::string const& film);

/// Renames them; no file is ever replaced. Frames move to a new folder, other files stay. Files that another run is
/// writing, or that the system does not let us rename, stay where they are, and the run will report them. Returns those
/// that were renamed, with the names that they have got.
std::vector<KeptFile> keep_earlier_files(Scenario const& scenario, std::string const& film);

/// The same for a run that goes on from a state, which adds its frames to those that are there. Throws OutputError if a
/// file cannot be renamed: rows of the earlier part would be lost.
std::vector<KeptFile> keep_earlier_part(Scenario const& scenario, std::string const& film);

/// Gives kept files their old names again, where no new file has them: for a run that did not start.
void give_back(std::vector<KeptFile> const& files);

}  // namespace pogosim
