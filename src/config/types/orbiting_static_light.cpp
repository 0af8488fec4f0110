// Objects of type `orbiting_static_light`: a static light moving along a circle.
#include <array>
#include <optional>
#include <span>

#include "config/lamp_keys.hpp"
#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

namespace {

struct OrbitCentre {
    std::optional<float> x_mm;
    std::optional<float> y_mm;
};

std::span<Key<OrbitCentre> const> orbit_centre_keys() {
    using K = Key<OrbitCentre>;
    static std::array const keys{
        K{"center_x", &OrbitCentre::x_mm, kCoordinate, "mm", "Centre of the circle; default: `x`."},
        K{"center_y", &OrbitCentre::y_mm, kCoordinate, "mm", "Centre of the circle; default: `y`."},
    };
    return keys;
}

std::span<Key<Orbit> const> orbit_keys() {
    using K = Key<Orbit>;
    constexpr auto goes_round = [](Orbit const& orbit) { return orbit.radius_mm > 0.0F; };
    static std::array const keys{
        K{"orbit_radius", &Orbit::radius_mm, kLengthOrZero, "mm",
          "Radius of the circle on which the lamp's centre moves; 0: it does not move."},
        K{"orbit_angular_speed", &Orbit::angular_speed_rad_s, kAngularSpeed, "rad/s",
          "Positive: clockwise on the screen."}
            .only_if(goes_round),
        K{"angular_speed", &Orbit::angular_speed_rad_s, kAngularSpeed, "rad/s", "Alias of orbit_angular_speed."}
            .only_if(goes_round)
            .other_name_of("orbit_angular_speed"),
        K{"orbit_phase", &Orbit::phase_rad, kAngle, "rad", "Position on the circle at time 0, clockwise from +x."}
            .only_if(goes_round),
    };
    return keys;
}

}  // namespace

void read_orbiting_static_light(MapReader& reader, ObjectConfig& object) {
    SpotSpec spec;
    read_shape(reader, any_geometry_keys(), spec.shape);
    read_spot(reader, spec);
    OrbitCentre centre;
    reader.read(orbit_centre_keys(), centre);
    spec.centre_mm = {centre.x_mm.value_or(spec.centre_mm.x), centre.y_mm.value_or(spec.centre_mm.y)};
    if (has_place(spec)) {
        bool const is_round_x_y = !centre.x_mm && !centre.y_mm;
        warn_of_lone_coordinate(reader, is_round_x_y ? "x" : "center_x", is_round_x_y ? "y" : "center_y",
                                spec.centre_mm);
    }
    reader.read(orbit_keys(), spec.orbit);
    object.spec.lamp = spec;
}

}  // namespace pogosim
