// Objects of type `rotating_ray_of_light`: a lighthouse with one beam.
#include <array>
#include <span>

#include "config/lamp_keys.hpp"
#include "config/object_parts.hpp"
#include "config/object_types.hpp"

namespace pogosim {

namespace {

std::span<Key<RotatingRaySpec> const> ray_keys() {
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

}  // namespace

void read_rotating_ray_of_light(MapReader& reader, ObjectConfig& object) {
    RotatingRaySpec spec;
    read_shape(reader, any_geometry_keys(), spec.shape);
    reader.read(lighthouse_centre_keys(), spec.centre_mm);
    if (!is_everywhere(spec.shape)) {
        warn_of_lone_coordinate(reader, "x", "y", spec.centre_mm);
    }
    reader.read(ray_keys(), spec);
    object.spec.lamp = spec;
}

}  // namespace pogosim
