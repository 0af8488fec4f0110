// Pictures of the window in files of the working folder.
#pragma once

#include <string>

#include "render/canvas.hpp"

namespace pogosim {

/// Writes screenshot-001.png, or with the first number that is free. What the user is to be told: the file, or why
/// there is none.
std::string save_screenshot(Canvas const& canvas);

}  // namespace pogosim
