// From a place in a program's code to the line of its source.
#pragma once

#include <string>

#include "process/program_image.hpp"

namespace pogosim {

/// "at main.c:31 in compute()" by the debug information of the program's file; "in compute()" by its symbols where
/// there is none; empty where there are none either, or the file has been built again since.
std::string place_in_source(ProgramImage const& image, void const* place);

}  // namespace pogosim
