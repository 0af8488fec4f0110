# Finds Apache Arrow C++ (10 or later): the system's, else the one inside the pyarrow wheel of a Python environment.
#
# Input:   POGOSIM_PYARROW    folder of an unpacked pyarrow package, for builds for another machine (default: none)
#          POGOSIM_PYTHON     Python that has pyarrow (default: the project's own .venv, which ./build.sh makes; in a build of
#                            the Python package, the Python of that build, whose pyarrow is always used)
# Output:  pogosim::arrow     target to link: headers (as system headers) and library
#          pogosim::parquet   the same with Parquet, if it is there
#          PogosimArrow_FOUND, PogosimArrow_VERSION, PogosimArrow_ORIGIN
#          PogosimArrow_LIBRARY_DIR   folder of the wheel's library, for RPATHs; empty for the system's

set(POGOSIM_PYARROW "" CACHE PATH "Folder of an unpacked pyarrow package to use, and no other Arrow")
if(POGOSIM_PYARROW)
    if(NOT IS_ABSOLUTE "${POGOSIM_PYARROW}" OR NOT EXISTS "${POGOSIM_PYARROW}/include/arrow/util/config.h")
        message(FATAL_ERROR "POGOSIM_PYARROW is ${POGOSIM_PYARROW}; expected the absolute path of the folder \"pyarrow\" of an "
            "unpacked package of PyPI, which has include/arrow")
    endif()
    set(Arrow_FOUND OFF)
elseif(SKBUILD)
    set(POGOSIM_PYTHON "${Python_EXECUTABLE}")
else()
    set(POGOSIM_PYTHON "${PROJECT_SOURCE_DIR}/.venv/bin/python" CACHE FILEPATH
        "Python whose pyarrow package is used if the system has no Apache Arrow")
    set(_isolated -I)  # keeps PYTHONPATH out, by which pip's builds find their packages
    find_package(Arrow CONFIG QUIET)  # the system's own
endif()

if(Arrow_FOUND AND Arrow_VERSION VERSION_GREATER_EQUAL 10)
    if(TARGET Arrow::arrow_shared)
        set(_arrow_target Arrow::arrow_shared)
    else()
        set(_arrow_target Arrow::arrow_static)
    endif()
    find_package(Parquet CONFIG QUIET)
    if(TARGET Parquet::parquet_shared)
        set(_parquet_target Parquet::parquet_shared)
    endif()
    set(PogosimArrow_VERSION "${Arrow_VERSION}")
    set(PogosimArrow_ORIGIN "${Arrow_DIR}")
elseif(POGOSIM_PYARROW OR EXISTS "${POGOSIM_PYTHON}")
    # Asked anew at each configuration: the wheel may have been replaced by another version.
    if(POGOSIM_PYARROW)
        file(STRINGS "${POGOSIM_PYARROW}/include/arrow/util/config.h" _pyarrow REGEX "ARROW_VERSION_STRING")
        string(REGEX REPLACE ".*\"([0-9.]+).*" "\\1;${POGOSIM_PYARROW}/include;${POGOSIM_PYARROW}" _pyarrow "${_pyarrow}")
        set(_pyarrow_result 0)
        set(POGOSIM_PYTHON "${POGOSIM_PYARROW}")
    else()
        execute_process(
            COMMAND "${POGOSIM_PYTHON}" ${_isolated} -c
                "import pyarrow; print(pyarrow.__version__, pyarrow.get_include(), *pyarrow.get_library_dirs(), sep=';', end='')"
            OUTPUT_VARIABLE _pyarrow RESULT_VARIABLE _pyarrow_result ERROR_VARIABLE _pyarrow_error)
    endif()
    if(_pyarrow_result EQUAL 0)
        list(POP_FRONT _pyarrow PogosimArrow_VERSION _arrow_include)
        # The wheel holds the library under its versioned name only: libarrow.so.2600, libarrow.2600.dylib.
        foreach(_dir IN LISTS _pyarrow)
            file(GLOB _found LIST_DIRECTORIES false "${_dir}/libarrow.so.*" "${_dir}/libarrow.*.dylib")
            list(FILTER _found INCLUDE REGEX "/libarrow\\.(so\\.[0-9]+|[0-9]+\\.dylib)$")
            list(APPEND _arrow_library ${_found})
            file(GLOB _found LIST_DIRECTORIES false "${_dir}/libparquet.so.*" "${_dir}/libparquet.*.dylib")
            list(FILTER _found INCLUDE REGEX "/libparquet\\.(so\\.[0-9]+|[0-9]+\\.dylib)$")
            list(APPEND _parquet_library ${_found})
        endforeach()
        if(_arrow_library)
            list(GET _arrow_library 0 _arrow_library)
            set(_arrow_target pogosim_pyarrow)
            set(PogosimArrow_ORIGIN "${_arrow_library}")
            get_filename_component(PogosimArrow_LIBRARY_DIR "${_arrow_library}" DIRECTORY)
        else()
            set(_arrow_problem "pyarrow ${PogosimArrow_VERSION} of ${POGOSIM_PYTHON} holds no libarrow in: ${_pyarrow}.")
        endif()
    else()
        set(_arrow_problem "${POGOSIM_PYTHON} cannot import pyarrow:\n${_pyarrow_error}")
    endif()
elseif(Arrow_FOUND)
    set(_arrow_problem "the Arrow in ${Arrow_DIR} is ${Arrow_VERSION}, expected 10 or later, and there is no ${POGOSIM_PYTHON}.")
else()
    set(_arrow_problem "there is no system Arrow for CMake to find, and no ${POGOSIM_PYTHON}.")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(PogosimArrow
    REQUIRED_VARS PogosimArrow_ORIGIN
    VERSION_VAR PogosimArrow_VERSION
    REASON_FAILURE_MESSAGE "${_arrow_problem}
    Run ./build.sh once: it makes .venv with pyarrow in it. Or install Arrow (Ubuntu 26.04 and later: libarrow-dev
    libparquet-dev), or give a Python that has pyarrow: cmake -DPOGOSIM_PYTHON=...")

if(PogosimArrow_FOUND AND NOT TARGET pogosim::arrow)
    if(_arrow_target STREQUAL "pogosim_pyarrow")
        # Programs in the build tree find the library by their RPATH, which CMake derives from its place.
        add_library(pogosim_pyarrow SHARED IMPORTED)
        set_target_properties(pogosim_pyarrow PROPERTIES
            IMPORTED_LOCATION "${_arrow_library}"
            INTERFACE_INCLUDE_DIRECTORIES "${_arrow_include}"
            INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${_arrow_include}")
    endif()
    add_library(pogosim::arrow INTERFACE IMPORTED)
    target_link_libraries(pogosim::arrow INTERFACE ${_arrow_target})
    if(_parquet_library)
        list(GET _parquet_library 0 _parquet_library)
        set(_parquet_target pogosim_pyarrow_parquet)
        add_library(pogosim_pyarrow_parquet SHARED IMPORTED)
        set_target_properties(pogosim_pyarrow_parquet PROPERTIES IMPORTED_LOCATION "${_parquet_library}")
    endif()
    if(_parquet_target)
        add_library(pogosim::parquet INTERFACE IMPORTED)
        target_link_libraries(pogosim::parquet INTERFACE ${_parquet_target} pogosim::arrow)
    endif()
endif()
