#include <fmt/format.h>

#include <string>

#include "pogosim/host.h"
#include "version/commit.hpp"

#ifdef __clang__
#define POGOSIM_COMPILER "clang " __clang_version__
#else
#define POGOSIM_COMPILER "gcc " __VERSION__
#endif

char const* pogosim_build_info(void) {
    static std::string const text = fmt::format("commit: {}\ncompiler: {}\nengines: {}\nArrow: {}\n", pogosim::commit(),
                                                POGOSIM_COMPILER, POGOSIM_ENGINES, POGOSIM_ARROW_VERSION);
    return text.c_str();
}
