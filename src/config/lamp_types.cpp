// Types of lamps.
#include <array>
#include <optional>
#include <span>

#include "config/lamp_keys.hpp"
#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

namespace {

void read_static_light(MapReader& reader, ObjectConfig& object) {
    SpotSpec spec;
    read_shape(reader, any_geometry_keys(), spec.shape);
    read_spot(reader, spec);
    if (has_place(spec)) {
        warn_of_lone_coordinate(reader, "x", "y", spec.centre_mm);
    }
    object.spec.lamp = spec;
}

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

std::span<Key<RotatingRaySpec> const> rotating_ray_keys() {
    using S = RotatingRaySpec;
    using K = Key<S>;
    static std::array const keys{
        K{"value", &S::value, kLightLevel, "sensor counts", "Level in the beam, replacing that of other lamps."},
        K{"ray_half_width", &S::half_width_rad, kHalfWidth, "rad",
          "Half-width of the beam, to either side of its direction."},
        K{"angular_speed", &S::angular_speed_rad_s, kAngularSpeed, "rad/s",
          "Positive: clockwise on the screen. 0: the beam stays at angle 0, along +x."},
        K{"white_frame_duration", &S::white_frame_duration_s, kSeconds, "s",
          "Duration of the flash over the whole shape, at the start and whenever the beam returns to angle 0, where it "
          "waits meanwhile."},
        K{"white_frame_value", &S::white_frame_value, kLightLevel, "sensor counts", "Level of the flash."},
        K{"photo_start_at", &S::photo_start_at_s, kStartTime, "s",
          "Dark until this time and for `photo_start_duration` after it. Negative: no photo start."},
        K{"photo_start_duration", &S::photo_start_duration_s, kSeconds, "s", "See photo_start_at."}.only_if(
            [](S const& spec) { return spec.photo_start_at_s >= 0.0; }),
    };
    return keys;
}

void read_rotating_ray_of_light(MapReader& reader, ObjectConfig& object) {
    RotatingRaySpec spec;
    read_shape(reader, any_geometry_keys(), spec.shape);
    reader.read(lighthouse_centre_keys(), spec.centre_mm);
    if (!is_everywhere(spec.shape)) {
        warn_of_lone_coordinate(reader, "x", "y", spec.centre_mm);
    }
    reader.read(rotating_ray_keys(), spec);
    object.spec.lamp = spec;
}

std::span<Key<AlternatingRaysSpec> const> alternating_rays_keys() {
    using S = AlternatingRaysSpec;
    using K = Key<S>;
    static std::array const keys{
        K{"value", &S::value, kLightLevel, "sensor counts", "Level in the beams, replacing that of other lamps."},
        K{"ray_half_width", &S::half_width_rad, kHalfWidth, "rad",
          "Half-width of a beam, to either side of its direction."},
        K{"angular_speed", &S::angular_speed_rad_s, kAngularSpeed, "rad/s",
          "Angular speed of both beams; positive: clockwise on the screen. 0: the first beam never moves."},
        K{"long_white_frame_duration", &S::long_white_frame_duration_s, kSeconds, "s",
          "Duration of the flash over the whole shape before the first beam."},
        K{"short_white_frame_duration", &S::short_white_frame_duration_s, kSeconds, "s",
          "Duration of the flash before the second beam."},
        K{"white_frame_value", &S::white_frame_value, kLightLevel, "sensor counts", "Level of both flashes."},
    };
    return keys;
}

void read_alternating_rays_of_light(MapReader& reader, ObjectConfig& object) {
    AlternatingRaysSpec spec;
    read_shape(reader, any_geometry_keys(), spec.shape);
    reader.read(lighthouse_centre_keys(), spec.centre_mm);
    if (!is_everywhere(spec.shape)) {
        warn_of_lone_coordinate(reader, "x", "y", spec.centre_mm);
    }
    reader.read(alternating_rays_keys(), spec);
    object.spec.lamp = spec;
}

constexpr std::array kLampTypes{
    ObjectType{"static_light", "Stationary lamp.", read_static_light},
    ObjectType{"orbiting_static_light", "Lamp that moves along a circle.", read_orbiting_static_light},
    ObjectType{"rotating_ray_of_light", "Lighthouse with one beam.", read_rotating_ray_of_light},
    ObjectType{"alternating_rays_of_light", "Two lighthouses in two corners, active in turn.",
               read_alternating_rays_of_light},
};

}  // namespace

std::span<ObjectType const> lamp_types() {
    return kLampTypes;
}

}  // namespace pogosim
