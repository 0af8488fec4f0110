// How strictly a configuration is read, and the mistakes in it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/problems.hpp"

namespace pogosim {

class ObjectTypes;

/// A file that a category names.
struct ObjectFile {
    std::filesystem::path path;  // as it was opened
    char const* what = "";       // "the robot model", "the script"
};

struct Reading {
    bool strict_keys = false;    // an unknown key is a mistake
    bool strict_values = false;  // so is a value that a run would cut, or replace by the default
    bool thorough = false;  // values without effect are checked, and slips in words of options do not end the reading
    Problems problems{};
    std::filesystem::path configuration{};   // the file; others that it names are searched beside it, too
    std::string firmware{};                  // that drives robots in the place of the program; empty: none does
    std::vector<ObjectFile> object_files{};  // that have been read
    ObjectTypes const* types = nullptr;      // that objects may have; null where no entries of `objects` are read
    bool strict_overrides = false;           // an unknown key that --set gives is a mistake, even if others are not
};

}  // namespace pogosim
