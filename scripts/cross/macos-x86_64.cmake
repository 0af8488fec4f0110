# Compiles for macOS on x86-64.
set(pogosim_processor x86_64)
include("${CMAKE_CURRENT_LIST_DIR}/macos.cmake")
