// Files of `robot_model`: a map of keys that hold for a category where its entry does not have them.
#pragma once

#include "config/reading.hpp"
#include "config/tree.hpp"

namespace pogosim {

/// Puts the keys of its model into each entry of `objects` that names one, in place of `robot_model`; each key knows
/// the file and line that it came from. The files are noted in `reading`. Mistakes are added to
/// `reading.problems`, and their entry stays as it is.
void include_robot_models(Node& root, Reading& reading);

}  // namespace pogosim
