# Compiles through ccache where it is installed, with settings by which builds of the same sources, here and in other clones,
# share what it has kept: paths are taken relative to the sources.
include_guard()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
    get_filename_component(ccache_settings "${CMAKE_CURRENT_LIST_DIR}" DIRECTORY)
    string(PREPEND ccache_settings CCACHE_BASEDIR=)
    # What gdb reads names the folder of its build, so it stays in the one that it is of.
    if(CMAKE_BUILD_TYPE MATCHES "^(Release|MinSizeRel)?$" OR POGOSIM_SANITIZE)
        list(APPEND ccache_settings CCACHE_NOHASHDIR=1)
    endif()
    if(pogosim_tools)  # compilers that scripts/cross/dependencies.py has written, into which it puts all that they depend on
        list(APPEND ccache_settings CCACHE_COMPILERCHECK=content)
    endif()
    if(POGOSIM_PRECOMPILE)  # without these, ccache would keep nothing that is compiled with precompiled headers
        list(APPEND ccache_settings CCACHE_SLOPPINESS=pch_defines,time_macros)
    endif()
    set(CMAKE_C_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env ${ccache_settings} "${CCACHE_PROGRAM}")
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_C_COMPILER_LAUNCHER})
endif()
