# What `cmake --install` copies: the public headers, the library, the arenas, what projects for robots need (the interface
# layer's C files, what firmware for the emulated processor needs, the tool that finds shared state, the project template),
# pogosim.pc and a CMake package. The build folder gets a pogosim.pc of its own, so that programs can be built against a tree
# that is not installed:
#
#   cc -std=c11 main.c -o prog $(PKG_CONFIG_PATH=build/release pkg-config --cflags --libs pogosim)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(tables pogosim_tables_module)
if(TARGET pogosim_parquet)
    list(APPEND tables pogosim_parquet)
endif()

if(POGOSIM_PYTHON_PACKAGE)
    # A Python package: in site-packages/pogosim/simulator/lib, with pyarrow beside pogosim. Wheels cannot hold links, so the
    # library has no versions in its name.
    set_target_properties(pogosim_library ${tables} PROPERTIES
        INSTALL_RPATH "$<IF:$<PLATFORM_ID:Darwin>,@loader_path,$ORIGIN>/../../../pyarrow")
    if(POGOSIM_SDL_FROM_PACKAGE)  # pysdl2-dll, beside pogosim, too
        set_target_properties(pogosim_window PROPERTIES
            INSTALL_RPATH "$<IF:$<PLATFORM_ID:Darwin>,@loader_path,$ORIGIN>/../../../sdl2dll/dll")
    endif()
else()
    # The installed library finds what is not in a system folder where it was at build time. CMake leaves folders inside of
    # the project out of that, such as the one of the Arrow in .venv, so this one is named.
    set_target_properties(pogosim_library PROPERTIES
        VERSION "${PROJECT_VERSION}"
        SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
    set_target_properties(pogosim_library ${tables} PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
    set_target_properties(${tables} PROPERTIES INSTALL_RPATH "${PogosimArrow_LIBRARY_DIR}")
    # Else CMake makes room for the longer one of two paths with colons, and libraries are looked for in the working folder.
    set_target_properties(pogosim_library ${tables} pogosim_without_program PROPERTIES BUILD_WITH_INSTALL_RPATH ON)
endif()
target_include_directories(pogosim INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

install(TARGETS pogosim pogosim_part_of_programs pogosim_library EXPORT pogosimTargets
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}"
    RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
install(TARGETS pogosim_window ${tables} LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}")  # libpogosim looks for it beside itself
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/${commit_file}" DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
    FILES_MATCHING PATTERN "*.h")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/arenas" DESTINATION "${CMAKE_INSTALL_DATADIR}/pogosim"
    FILES_MATCHING PATTERN "*.csv")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/models" DESTINATION "${CMAKE_INSTALL_DATADIR}/pogosim"
    FILES_MATCHING PATTERN "*.yaml")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/src/interface" DESTINATION "${CMAKE_INSTALL_DATADIR}/pogosim"
    FILES_MATCHING PATTERN "*.c")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/src/emu" DESTINATION "${CMAKE_INSTALL_DATADIR}/pogosim"
    FILES_MATCHING PATTERN "*.h" PATTERN "*.c" PATTERN "*.S" PATTERN "*.ld" PATTERN "*.mk")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/template_prj" DESTINATION "${CMAKE_INSTALL_DATADIR}/pogosim"
    FILES_MATCHING PATTERN "Makefile" PATTERN "*.mk" PATTERN "*.c" PATTERN "*.yaml" PATTERN "*.md" PATTERN ".gitignore"
    PATTERN "build" EXCLUDE PATTERN "frames" EXCLUDE)
# The pages that messages name, for `pogosim docs`; without pictures.
file(GLOB pages CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/*.md")
install(FILES ${pages} DESTINATION "${CMAKE_INSTALL_DATADIR}/pogosim/docs")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs/decisions" DESTINATION "${CMAKE_INSTALL_DATADIR}/pogosim/docs"
    FILES_MATCHING PATTERN "*.md")
install(FILES "${PROJECT_SOURCE_DIR}/CHANGELOG.md" DESTINATION "${CMAKE_INSTALL_DATADIR}/pogosim")
# What docs/clusters.md lets sites copy.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/containers" "${PROJECT_SOURCE_DIR}/modules"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/pogosim")
install(TARGETS pogosim_without_program RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
if(TARGET pogosim_shared_state)
    install(TARGETS pogosim_shared_state RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endif()

# find_package(pogosim) gives pogosim::pogosim.
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/pogosim")
install(EXPORT pogosimTargets NAMESPACE pogosim:: DESTINATION "${package_dir}")
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/pogosimConfig.cmake.in"
    "${PROJECT_BINARY_DIR}/cmake/pogosimConfig.cmake" INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/cmake/pogosimConfigVersion.cmake"
    COMPATIBILITY SameMinorVersion)
install(FILES
    "${PROJECT_BINARY_DIR}/cmake/pogosimConfig.cmake"
    "${PROJECT_BINARY_DIR}/cmake/pogosimConfigVersion.cmake"
    DESTINATION "${package_dir}")

# How programs are compiled: pogosim.pc for pkg-config (pogosim-sdk.pc for programs written for the robots' SDK,
# pogosim-host.pc for processes that step runs), and the same in pogosim.mk for make, which needs no pkg-config. Once
# for each of the two places. The installed ones are relative to themselves: the tree may be moved, and `cmake --install
# --prefix` may choose the place late. Blanks in paths are escaped as pkg-config and shells want it.
set(build_settings pogosim.pc pogosim-sdk.pc pogosim-host.pc pogosim.mk pogosim-original.mk)
function(pogosim_build_settings folder)
    foreach(place includedir libdir without_program interfacedir emudir shared_state template)
        string(REPLACE " " "\\ " ${place} "${${place}}")
    endforeach()
    foreach(file IN LISTS build_settings)
        configure_file("${PROJECT_SOURCE_DIR}/cmake/${file}.in" "${folder}/${file}" @ONLY)
    endforeach()
endfunction()

if(APPLE)
    set(symbol_prefix "_")
endif()
file(RELATIVE_PATH to_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
set(prefix "\${pcfiledir}/${to_prefix}")
set(includedir "${prefix}${CMAKE_INSTALL_INCLUDEDIR}")
set(libdir "${prefix}${CMAKE_INSTALL_LIBDIR}")
set(interfacedir "${prefix}${CMAKE_INSTALL_DATADIR}/pogosim/interface")
set(emudir "${prefix}${CMAKE_INSTALL_DATADIR}/pogosim/emu")
set(shared_state "${prefix}${CMAKE_INSTALL_BINDIR}/pogosim-shared-state")
set(without_program "${prefix}${CMAKE_INSTALL_BINDIR}/pogosim-without-program")
set(template "${prefix}${CMAKE_INSTALL_DATADIR}/pogosim/template_prj")
pogosim_build_settings("${PROJECT_BINARY_DIR}/cmake")
list(TRANSFORM build_settings PREPEND "${PROJECT_BINARY_DIR}/cmake/" OUTPUT_VARIABLE installed_settings)
install(FILES ${installed_settings} DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")

set(includedir "${PROJECT_SOURCE_DIR}/include")
get_target_property(libdir pogosim_library LIBRARY_OUTPUT_DIRECTORY)
if(NOT libdir)
    get_target_property(libdir pogosim_library BINARY_DIR)
endif()
set(interfacedir "${PROJECT_SOURCE_DIR}/src/interface")
set(emudir "${PROJECT_SOURCE_DIR}/src/emu")
set(shared_state "${PROJECT_BINARY_DIR}/tools/pogosim-shared-state")
set(without_program "${PROJECT_BINARY_DIR}/src/pogosim-without-program")
set(template "${PROJECT_SOURCE_DIR}/template_prj")
pogosim_build_settings("${PROJECT_BINARY_DIR}")
