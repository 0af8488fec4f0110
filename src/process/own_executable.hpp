// The file of this process's executable.
#pragma once

#include <filesystem>

#ifdef __APPLE__
#include <mach-o/dyld.h>

#include <cstdint>
#include <string>
#endif

namespace pogosim {

/// A path that leads to it, whatever the working folder is. Empty if the system does not tell.
inline std::filesystem::path own_executable() {
#ifdef __APPLE__
    std::uint32_t bytes = 0;
    _NSGetExecutablePath(nullptr, &bytes);
    std::string path(bytes, '\0');
    return _NSGetExecutablePath(path.data(), &bytes) == 0 ? std::filesystem::path(path.c_str())
                                                          : std::filesystem::path();
#else
    return "/proc/self/exe";
#endif
}

}  // namespace pogosim
