# gcc of Debian, with what dependencies.py has left in build/cross/TARGET: libraries that stand for older ones (old_libraries.py),
# and those that our code is built from.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR "${pogosim_processor}")
set(CMAKE_C_COMPILER "${pogosim_compiler}gcc")
set(CMAKE_CXX_COMPILER "${pogosim_compiler}g++")
get_filename_component(pogosim_cross "${CMAKE_CURRENT_LIST_DIR}/../../build/cross/linux-${pogosim_processor}" ABSOLUTE)
set(pogosim_old_libraries "${pogosim_cross}/old")
foreach(kind IN ITEMS EXE SHARED MODULE)
    set(CMAKE_${kind}_LINKER_FLAGS_INIT "-L${pogosim_old_libraries} -Wl,--no-as-needed")
endforeach()
foreach(kind IN ITEMS SHARED MODULE)  # what no library offers is told now, not when a program starts
    string(APPEND CMAKE_${kind}_LINKER_FLAGS_INIT " -Wl,-z,defs")
endforeach()
include("${CMAKE_CURRENT_LIST_DIR}/prefix.cmake")
