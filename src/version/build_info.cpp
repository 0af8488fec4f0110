#include <fmt/format.h>

#include <fstream>
#include <string>

#include "base/library_folder.hpp"
#include "pogosim/host.h"

#ifdef __clang__
#define POGOSIM_COMPILER "clang " __clang_version__
#else
#define POGOSIM_COMPILER "gcc " __VERSION__
#endif

namespace {

/// What the build has written beside the library, see cmake/commit.cmake.
std::string commit() {
    std::ifstream file(pogosim::library_folder() / POGOSIM_COMMIT_FILE);
    std::string line;
    std::getline(file, line);
    return line.empty() ? "unknown" : line;
}

}  // namespace

char const* pogosim_build_info(void) {
    static std::string const text = fmt::format("commit: {}\ncompiler: {}\nengines: {}\nArrow: {}\n", commit(),
                                                POGOSIM_COMPILER, POGOSIM_ENGINES, POGOSIM_ARROW_VERSION);
    return text.c_str();
}
