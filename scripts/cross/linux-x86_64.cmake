# Compiles on Debian for Linux on x86-64, for C and C++ libraries of 2018 and later.
set(pogosim_processor x86_64)
set(pogosim_compiler "")
include("${CMAKE_CURRENT_LIST_DIR}/linux.cmake")
