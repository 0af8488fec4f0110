// The commit that the library was built of.
#pragma once

#include <string>

namespace pogosim {

/// What the build has written beside the library, see cmake/commit.cmake; "unknown" if the file is missing.
std::string commit();

}  // namespace pogosim
