# The commit of the sources, for `pogosim --version`: pogosim_commit(library file) has each build, once the library is made,
# look which commit it is, and write it into the file, which is beside the library, if it is another one. It is not in the
# library: a commit that changes no source compiles and links nothing, and states that were saved before still fit.
#
# It is what git describes; outside of a checkout, what was recorded when the sources were packed: in cmake/sdist_commit.txt
# (a source distribution of Python, see cmake/recorded_commit.py) or cmake/archive_commit.txt (git archive); else "unknown".
# If git fails in a checkout, as in one of another user, a line of the build says so.
function(pogosim_commit library file)
    add_custom_target(${library}_commit ALL BYPRODUCTS "${file}" VERBATIM
        COMMAND "${CMAKE_COMMAND}" "-DFOLDER=${PROJECT_SOURCE_DIR}" "-DFILE=${file}"
                -P "${PROJECT_SOURCE_DIR}/cmake/commit.cmake")
    add_dependencies(${library}_commit ${library})
endfunction()

if(NOT CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
    return()
endif()

set(commit "unknown")
foreach(name IN ITEMS archive_commit.txt sdist_commit.txt)
    if(EXISTS "${FOLDER}/cmake/${name}")
        file(STRINGS "${FOLDER}/cmake/${name}" line REGEX "^[-.A-Za-z0-9]+$" LIMIT_COUNT 1)
        if(line)
            set(commit "${line}")
        endif()
    endif()
endforeach()
# A checkout of its own: the repository of a project that has a copy of these sources has other commits.
if(EXISTS "${FOLDER}/.git")
    execute_process(COMMAND git -C "${FOLDER}" describe --always --tags --dirty
        OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE result ERROR_VARIABLE error)
    if(result EQUAL 0)
        set(commit "${described}")
    else()
        string(REGEX REPLACE "\n.*" "" reason "${error}")
        if(NOT reason)
            set(reason "${result}") # such as that there is no git
        endif()
        message(NOTICE "commit.cmake: git cannot describe the checkout ${FOLDER}, so its commit is recorded as \"${commit}\": ${reason}")
    endif()
endif()
set(known "")
if(EXISTS "${FILE}")
    file(READ "${FILE}" known)
endif()
if(NOT known STREQUAL "${commit}\n")
    file(WRITE "${FILE}" "${commit}\n")
endif()
