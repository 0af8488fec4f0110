// The file that a run writes next to its data file before replacing it. One at a time; it must not be left behind, even
// if the program ends in a signal handler.
#pragma once

#include <filesystem>

namespace pogosim {

/// Registers the scratch file.
void remember_scratch_file(std::filesystem::path const& path);

/// The scratch file has become a user's file, or is gone.
void forget_scratch_file();

/// Removes it, if there is one and this process made it. May be called in a signal handler.
void remove_scratch_file() noexcept;

}  // namespace pogosim
