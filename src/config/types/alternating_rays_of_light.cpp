// Objects of type `alternating_rays_of_light`: two lighthouses in turn.
#include <array>
#include <span>

#include "config/lamp_keys.hpp"
#include "config/object_parts.hpp"
#include "config/object_types.hpp"

namespace pogosim {

namespace {

std::span<Key<AlternatingRaysSpec> const> ray_keys() {
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

}  // namespace

void read_alternating_rays_of_light(MapReader& reader, ObjectConfig& object) {
    AlternatingRaysSpec spec;
    read_shape(reader, any_geometry_keys(), spec.shape);
    reader.read(lighthouse_centre_keys(), spec.centre_mm);
    if (!is_everywhere(spec.shape)) {
        warn_of_lone_coordinate(reader, "x", "y", spec.centre_mm);
    }
    reader.read(ray_keys(), spec);
    object.spec.lamp = spec;
}

}  // namespace pogosim
