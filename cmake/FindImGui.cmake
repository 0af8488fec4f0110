# Finds Dear ImGui, built as a library: through pkg-config, else by its header and library in the usual places.
#
# Output:  ImGui::ImGui       target to link: headers (as system headers) and library
#          ImGui_FOUND

find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
    pkg_check_modules(PogosimImGui QUIET IMPORTED_TARGET imgui)
endif()
if(TARGET PkgConfig::PogosimImGui)
    set(_imgui_target PkgConfig::PogosimImGui)
    set(ImGui_ORIGIN "${PogosimImGui_LINK_LIBRARIES}")
else()
    find_path(ImGui_INCLUDE_DIR imgui.h PATH_SUFFIXES imgui)
    find_library(ImGui_LIBRARY imgui)
    mark_as_advanced(ImGui_INCLUDE_DIR ImGui_LIBRARY)
    if(ImGui_INCLUDE_DIR AND ImGui_LIBRARY)
        set(ImGui_ORIGIN "${ImGui_LIBRARY}")
    endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ImGui REQUIRED_VARS ImGui_ORIGIN
    REASON_FAILURE_MESSAGE "Install it (Debian: libimgui-dev, Homebrew: imgui), or name imgui.h's folder and the library:
    cmake -DImGui_INCLUDE_DIR=... -DImGui_LIBRARY=...")

if(ImGui_FOUND AND NOT TARGET ImGui::ImGui)
    add_library(ImGui::ImGui INTERFACE IMPORTED)
    if(_imgui_target)
        target_link_libraries(ImGui::ImGui INTERFACE ${_imgui_target})
    else()
        target_link_libraries(ImGui::ImGui INTERFACE "${ImGui_LIBRARY}")
        target_include_directories(ImGui::ImGui SYSTEM INTERFACE "${ImGui_INCLUDE_DIR}")
    endif()
endif()
