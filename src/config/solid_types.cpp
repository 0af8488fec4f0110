// Types of objects with which robots collide or communicate.
#include <array>
#include <span>

#include "config/object_parts.hpp"
#include "config/object_types.hpp"

namespace pogosim {

namespace {

void read_pogobot(MapReader& reader, ObjectConfig& object) {
    object.spec.shape = kPogobotShape;
    read_solid_shape(reader, robot_geometry_keys(), object.spec.shape);
    read_robot(reader, object);
    read_body(reader, object);
    read_placement(reader, object);
}

void read_pogobject(MapReader& reader, ObjectConfig& object) {
    read_solid_shape(reader, solid_geometry_keys(), object.spec.shape);
    read_robot(reader, object, head_model());
    read_body(reader, object);
    read_placement(reader, object);
}

void read_pogowall(MapReader& reader, ObjectConfig& object) {
    read_shape(reader, outline_geometry_keys(), object.spec.shape);
    read_robot(reader, object, outline_model());
    if (object.spec.shape.kind == ShapeKind::arena) {
        ignore_position(reader);
        return;
    }
    read_position(reader, object);
    bool const has_shape =
        reader.find("geometry") != nullptr && !reader.reading().problems.has_key(reader.path_of("geometry"));
    if (!object.position_mm && has_shape) {
        reader.collect([&] { fail_at(reader.place(), "needs x and y: no formation places a wall of this geometry"); });
    }
}

constexpr int kMostBodies = 10000;  // of one membrane

std::span<Key<MembraneSpec> const> membrane_keys() {
    using K = Key<MembraneSpec>;
    constexpr auto has_dot_radius = [](MembraneSpec const& membrane) {
        return !(membrane.segments && membrane.thickness_mm);
    };
    constexpr auto has_springs = [](MembraneSpec const& membrane) {
        return !membrane.segments || membrane.cross_span > 1;
    };
    static std::array const keys{
        K{"num_dots", &MembraneSpec::body_count, between(3, kMostBodies), "", "Number of bodies along the outline."},
        K{"dot_radius", &MembraneSpec::radius_mm, between(1e-3, kMaxLength).usually_from(0.1), "mm", "Radius of a dot."}
            .only_if(has_dot_radius),
        K{"cross_span", &MembraneSpec::cross_span, between(0, kMostBodies), "dots",
          "Above 1: adds weaker springs from each dot to the one this many places further on, which keep the membrane "
          "from folding."},
        K{"stiffness", &MembraneSpec::stiffness_hz, above(0).up_to(1e4), "Hz",
          "Natural frequency of the springs between neighbours; their damping ratio is body_linear_damping."}
            .only_if(has_springs),
        K{"serialize_dot_pose", &MembraneSpec::in_data_file, any(), "",
          "Record each dot as a row of the data file, with its number in the column subpart_id."},
    };
    return keys;
}

std::span<Key<MembraneSpec> const> thickness_keys() {
    using K = Key<MembraneSpec>;
    static std::array const keys{
        K{"rect_thickness", &MembraneSpec::thickness_mm, between(1e-3, kMaxLength).usually_from(0.1), "mm",
          "Thickness of the segments; default: dot_radius."},
    };
    return keys;
}

void read_membrane_object(MapReader& reader, ObjectConfig& object, bool segments) {
    read_shape(reader, ring_geometry_keys(), object.spec.shape);
    read_robot(reader, object, outline_model());
    read_body(reader, object);
    read_blocking(reader, object);
    MembraneSpec& membrane = object.spec.membrane.emplace();
    membrane.segments = segments;
    if (segments) {
        reader.read(thickness_keys(), membrane);
    }
    reader.read(membrane_keys(), membrane);
    read_placement(reader, object);
    read_colormap(reader, object);
}

void read_membrane(MapReader& reader, ObjectConfig& object) {
    read_membrane_object(reader, object, /*segments=*/false);
}

void read_rectmembrane(MapReader& reader, ObjectConfig& object) {
    read_membrane_object(reader, object, /*segments=*/true);
}

void read_active_object(MapReader& reader, ObjectConfig& object) {
    read_solid_shape(reader, solid_geometry_keys(), object.spec.shape);
    read_robot(reader, object, active_model());
    read_body(reader, object);
    read_placement(reader, object);
    read_colormap(reader, object);
}

void read_passive_object(MapReader& reader, ObjectConfig& object) {
    read_solid_shape(reader, solid_geometry_keys(), object.spec.shape);
    read_body(reader, object);
    read_blocking(reader, object);
    read_placement(reader, object);
    read_colormap(reader, object);
}

constexpr std::array kSolidTypes{
    ObjectType{"pogobot", "Robot with two motors and four infrared emitters.", read_pogobot},
    ObjectType{"pogobject", "Head of a robot on a large body without motors.", read_pogobject},
    ObjectType{"pogowall", "Wall that runs user code and sends along its whole length.", read_pogowall},
    ObjectType{"membrane", "Soft ring of disks that runs user code and sends along its whole length.", read_membrane},
    ObjectType{"rectmembrane", "Like membrane, but made of rectangular segments.", read_rectmembrane},
    ObjectType{"active_object", "Pushable body with a program and infrared.", read_active_object},
    ObjectType{"passive_object", "Pushable body.", read_passive_object},
};

}  // namespace

std::span<ObjectType const> solid_types() {
    return kSolidTypes;
}

}  // namespace pogosim
