# Headers of libraries, parsed once for many targets:
#
#   pogosim_precompile(TARGET OWNER HEADERS...)
#
# TARGET takes what is compiled with OWNER, a target of the same kind and level of optimisation, which may be TARGET itself.
# With clang and POGOSIM_PRECOMPILE only: gcc gains little, and wants the same flags and definitions in all targets. Files
# include what they use nevertheless: other builds have nothing precompiled.
function(pogosim_precompile target owner)
    if(NOT POGOSIM_PRECOMPILE OR NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
        return()
    endif()
    if(target STREQUAL owner)
        list(TRANSFORM ARGN REPLACE "(.+)" "$<$<COMPILE_LANGUAGE:CXX>:<\\1$<ANGLE-R>>")
        target_precompile_headers(${target} PRIVATE ${ARGN})
    else()
        target_precompile_headers(${target} REUSE_FROM ${owner})
    endif()
    # The same bytes whenever it is made, so that ccache knows what was compiled with it.
    target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
endfunction()

set(POGOSIM_PRECOMPILED
    algorithm array cmath cstdint filesystem functional map memory optional span string string_view utility variant vector
    fmt/format.h fmt/ranges.h)
