// Objects of type `static_light`.
#include <array>

#include "config/object_parts.hpp"
#include "config/object_types.hpp"

namespace pogosim {

namespace {

constexpr Range kLightLevel = between(0, 32767);
constexpr Range kSeconds = between(0, 1e9);

std::span<Key<LampSpec> const> lamp_keys() {
    using K = Key<LampSpec>;
    static std::array const keys{
        K{"light_mode",
          one_of(&LampSpec::mode,
                 {{"static", LightMode::uniform}, {"gradient", LightMode::gradient}, {"plane", LightMode::plane}},
                 {.warns_only = true}),
          any(), "",
          "static: `value` everywhere. gradient: linear from `value` at the centre to `edge_value` at "
          "`gradient_radius`. plane: linear along `plane_angle`, from `value` to `edge_value`."},
        K{"value", &LampSpec::value, kLightLevel, "sensor counts", "Light level; levels of several lamps add up."},
        K{"edge_value", &LampSpec::edge_value, kLightLevel, "sensor counts",
          "gradient and plane: level at the far side."},
        K{"gradient_radius", &LampSpec::gradient_radius_mm, between(-kMaxLength, kMaxLength), "mm",
          "gradient: where `edge_value` is reached; 0 or less: the largest distance inside the shape."},
        K{"plane_angle", &LampSpec::plane_angle_rad, between(-1e4, 1e4), "rad",
          "plane: direction of the normal, clockwise on the screen from +x."},
        K{"plane_half_span", &LampSpec::plane_half_span_mm, above(0).up_to(kMaxLength), "mm",
          "plane: distance from the centre at which `value` (behind) and `edge_value` (ahead) are reached."},
        K{"photo_start_at", &LampSpec::photo_start_at_s, between(-1e9, 1e9), "s",
          "At 0 or later: dark before, then a flash, then the normal light. Negative: no flash."},
        K{"photo_start_duration", &LampSpec::photo_start_duration_s, kSeconds, "s", "Length of the flash."},
        K{"photo_start_value", &LampSpec::photo_start_value, kLightLevel, "sensor counts", "Level of the flash."},
    };
    return keys;
}

std::span<Key<Vec2> const> centre_keys() {
    using K = Key<Vec2>;
    static std::array const keys{
        K{"x", &Vec2::x, between(-kMaxLength, kMaxLength), "mm", "Centre."},
        K{"y", &Vec2::y, between(-kMaxLength, kMaxLength), "mm", "Centre."},
    };
    return keys;
}

}  // namespace

void read_static_light(MapReader& reader, ObjectConfig& object) {
    LampSpec& lamp = object.spec.lamp.emplace();
    read_shape(reader, any_geometry_keys(), lamp.shape);
    reader.read(centre_keys(), lamp.centre_mm);
    reader.read(lamp_keys(), lamp);
}

}  // namespace pogosim
