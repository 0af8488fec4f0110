#pragma once

#include <filesystem>

namespace pogosim {

/// The folder of the library that this code is part of (libpogosim or the module of the window), wherever it has been
/// moved to; empty if the system does not know it.
std::filesystem::path library_folder();

}  // namespace pogosim
