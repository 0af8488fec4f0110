// One object of each type, as the configuration makes them, for scenes made in code.
#pragma once

#include <string>

#include "support/scenes.hpp"

namespace pogosim::testing {

inline ObjectConfig object_of_type(std::string const& type, std::string const& category, ObjectSpec const& spec) {
    ObjectConfig object;
    object.category = category;
    object.type = type;
    object.spec = spec;
    return object;
}

inline ObjectConfig at(ObjectConfig object, Vec2 position_mm) {
    object.position_mm = position_mm;
    return object;
}

/// A wall along all polygons of the arena.
inline ObjectConfig arena_wall(std::string const& category = "walls") {
    ObjectSpec spec = article_robot();
    spec.shape = {.kind = ShapeKind::arena};
    spec.body.reset();
    spec.robot->model = outline_model();
    return object_of_type("pogowall", category, spec);
}

/// A membrane of the default make, a disk of 200 mm.
inline ObjectConfig membrane(bool segments = false, std::string const& category = "membranes") {
    ObjectSpec spec = article_robot();
    spec.shape = {.kind = ShapeKind::disk, .radius_mm = 200.0F};
    spec.robot->model = outline_model();
    spec.membrane.emplace().segments = segments;
    return object_of_type(segments ? "rectmembrane" : "membrane", category, spec);
}

/// The head of a robot on a disk of 80 mm.
inline ObjectConfig pogobject(std::string const& category = "pogobjects") {
    ObjectSpec spec = article_robot();
    spec.shape.radius_mm = 80.0F;
    spec.robot->model = head_model();
    return object_of_type("pogobject", category, spec);
}

inline ObjectConfig active_object(Shape const& shape, std::string const& category = "active") {
    ObjectSpec spec = article_robot();
    spec.shape = shape;
    spec.robot->model = active_model();
    return object_of_type("active_object", category, spec);
}

inline ObjectConfig passive_object(Shape const& shape, std::string const& category = "passive") {
    ObjectSpec spec;
    spec.shape = shape;
    spec.body.emplace();
    return object_of_type("passive_object", category, spec);
}

}  // namespace pogosim::testing
