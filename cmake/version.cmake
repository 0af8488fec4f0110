# Reads the version from include/pogosim/version.h, where it stands, into POGOSIM_VERSION. The Python package has a copy of it,
# which commands can read before they know where the headers are: a build with another one ends here.
set(header "${CMAKE_CURRENT_LIST_DIR}/../include/pogosim/version.h")
set(package "${CMAKE_CURRENT_LIST_DIR}/../python/pogosim/__init__.py")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${header}" "${package}")

set(POGOSIM_VERSION "")
foreach(part IN ITEMS MAJOR MINOR PATCH)
    file(STRINGS "${header}" line REGEX "^#define POGOSIM_VERSION_${part} [0-9]+$")
    string(REGEX REPLACE "^.* " "" number "${line}")
    list(APPEND POGOSIM_VERSION "${number}")
endforeach()
list(JOIN POGOSIM_VERSION "." POGOSIM_VERSION)

file(STRINGS "${package}" line REGEX "^__version__ = ")
if(NOT line STREQUAL "__version__ = \"${POGOSIM_VERSION}\"")
    message(FATAL_ERROR "include/pogosim/version.h says version ${POGOSIM_VERSION}, but python/pogosim/__init__.py has the line\n"
        "  ${line}\nWrite the version of the header there: __version__ = \"${POGOSIM_VERSION}\"")
endif()
