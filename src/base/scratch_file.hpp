// The file that a run writes beside its data file before it takes that one's place. One at a time; it must not be left
// behind, even when the program ends in a signal handler.
#pragma once

#include <filesystem>

namespace pogosim {

/// From now on this file is scratch.
void remember_scratch_file(std::filesystem::path const& path);

/// It has become a file of the user's, or is gone.
void forget_scratch_file();

/// Removes it, if there is one and this process made it. May be called in a signal handler.
void remove_scratch_file() noexcept;

}  // namespace pogosim
