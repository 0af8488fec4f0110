# Compiles for macOS on Apple silicon.
set(pogosim_processor arm64)
include("${CMAKE_CURRENT_LIST_DIR}/macos.cmake")
