# zig, of the package ziglang of PyPI: its clang compiles for macOS 12 and later, with headers and libraries of its own.
set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_SYSTEM_VERSION 21)  # of the kernel: macOS 12
set(CMAKE_SYSTEM_PROCESSOR "${pogosim_processor}")
set(CMAKE_OSX_DEPLOYMENT_TARGET "" CACHE STRING "zig's target says it")
set(CMAKE_OSX_SYSROOT "" CACHE STRING "zig has headers of its own")
set(CMAKE_OSX_ARCHITECTURES "" CACHE STRING "zig's target says it")
get_filename_component(pogosim_cross "${CMAKE_CURRENT_LIST_DIR}/../../build/cross/macos-${pogosim_processor}" ABSOLUTE)
set(pogosim_tools "${pogosim_cross}/tools")  # which dependencies.py makes
set(CMAKE_C_COMPILER "${pogosim_tools}/cc")
set(CMAKE_CXX_COMPILER "${pogosim_tools}/c++")
set(CMAKE_ASM_COMPILER "${pogosim_tools}/cc")
set(CMAKE_AR "${pogosim_tools}/ar" CACHE FILEPATH "" FORCE)
set(CMAKE_RANLIB "${pogosim_tools}/ranlib" CACHE FILEPATH "" FORCE)
# install_name_tool, with which CMake would change paths when it installs: it is not there, so they are the final ones at once.
set(CMAKE_INSTALL_NAME_TOOL /bin/true CACHE FILEPATH "" FORCE)
set(CMAKE_STRIP /bin/true CACHE FILEPATH "" FORCE)  # that of Linux knows no such files: the linker leaves out what it would
foreach(kind IN ITEMS SHARED MODULE EXE)
    set(CMAKE_${kind}_LINKER_FLAGS_INIT "-s")
endforeach()
set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
set(CMAKE_BUILD_WITH_INSTALL_NAME_DIR ON)
set(CMAKE_INSTALL_NAME_DIR "@rpath")
# Names of C++ stay inside: zig's linker cannot be told so. Of zig's <float.h> and <math.h>, the second to be included would
# lack its macros, FLT_MAX and others or INFINITY.
set(CMAKE_C_FLAGS_INIT "-fvisibility=hidden -g0")  # a library that programs are linked with would name folders of this machine
set(CMAKE_CXX_FLAGS_INIT "-fvisibility=hidden -fvisibility-inlines-hidden -include cfloat -include __float_infinity_nan.h")
set(CMAKE_USER_MAKE_RULES_OVERRIDE "${CMAKE_CURRENT_LIST_DIR}/macos_rules.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/prefix.cmake")
