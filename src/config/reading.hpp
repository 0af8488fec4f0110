// How strictly a configuration is read, and the mistakes in it.
#pragma once

#include "base/problems.hpp"

namespace pogosim {

struct Reading {
    bool strict_keys = false;    // an unknown key is a mistake
    bool strict_values = false;  // so is a value that a run would cut, or replace by the default
    bool thorough = false;  // values without effect are checked, and slips in words of options do not end the reading
    Problems problems{};
};

}  // namespace pogosim
