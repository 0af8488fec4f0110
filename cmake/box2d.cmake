# Box2D 2.4, a second engine that moves bodies. Sets POGOSIM_HAS_BOX2D; then, box2d::box2d is there.
#
# Box2D 3 is another library of the same name, for C. Some distributions have no other one any more.
include_guard()
include(CheckCXXSourceCompiles)

include("${CMAKE_CURRENT_LIST_DIR}/closed_list.cmake")
pogosim_choice(POGOSIM_BOX2D AUTO "The physics engine box2d: ON, OFF, or AUTO: if Box2D 2.4 is there" AUTO ON OFF)

set(POGOSIM_HAS_BOX2D OFF)
if(POGOSIM_BOX2D STREQUAL "AUTO" OR POGOSIM_BOX2D)
    find_package(box2d QUIET)
    if(box2d_FOUND)
        set(CMAKE_REQUIRED_LIBRARIES box2d::box2d)
        check_cxx_source_compiles("#include <box2d/b2_world.h>
            int main() { return b2World(b2Vec2(0.0F, 0.0F)).GetBodyCount(); }" POGOSIM_BOX2D_FITS)
        unset(CMAKE_REQUIRED_LIBRARIES)
        set(POGOSIM_HAS_BOX2D "${POGOSIM_BOX2D_FITS}")
        set(found "the Box2D in ${box2d_DIR} (${box2d_VERSION}) does not fit")
    else()
        set(found "Box2D is not installed")
    endif()
    set(wanted "Pogosim needs Box2D 2.4, not 3 (Debian and Ubuntu: libbox2d-dev)")
    if(NOT POGOSIM_HAS_BOX2D AND POGOSIM_BOX2D STREQUAL "AUTO")
        message(STATUS "Built without physics_engine: box2d: ${found}. ${wanted}")
    elseif(NOT POGOSIM_HAS_BOX2D)
        message(FATAL_ERROR "POGOSIM_BOX2D is ${POGOSIM_BOX2D}, but ${found}. ${wanted}. "
            "With -DPOGOSIM_BOX2D=OFF, all objects are moved by our own engine.")
    endif()
endif()
