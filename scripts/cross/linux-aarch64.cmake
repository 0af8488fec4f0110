# Compiles on Debian for Linux on ARM64, for C and C++ libraries of 2018 and later.
set(pogosim_processor aarch64)
set(pogosim_compiler aarch64-linux-gnu-)
include("${CMAKE_CURRENT_LIST_DIR}/linux.cmake")
