#include "config/lamp_keys.hpp"

#include <array>

#include "config/shape_keys.hpp"

namespace pogosim {

namespace {

std::span<Key<Vec2> const> spot_centre_keys() {
    using K = Key<Vec2>;
    static std::array const keys{
        K{"x", &Vec2::x, kCoordinate, "mm", "Centre."},
        K{"y", &Vec2::y, kCoordinate, "mm", "Centre."},
    };
    return keys;
}

std::span<Key<SpotSpec> const> spot_keys() {
    using K = Key<SpotSpec>;
    constexpr auto is_gradient = [](SpotSpec const& spot) { return spot.mode == LightMode::gradient; };
    constexpr auto is_plane = [](SpotSpec const& spot) { return spot.mode == LightMode::plane; };
    constexpr auto has_edge = [](SpotSpec const& spot) { return spot.mode != LightMode::uniform; };
    constexpr auto has_photo_start = [](SpotSpec const& spot) { return spot.photo_start_at_s >= 0.0F; };
    static std::array const keys{
        K{"light_mode",
          one_of(&SpotSpec::mode,
                 {{"static", LightMode::uniform}, {"gradient", LightMode::gradient}, {"plane", LightMode::plane}},
                 {.warns_only = true}),
          any(), "",
          "static: `value` everywhere. gradient: linear from `value` at the centre to `edge_value` at "
          "`gradient_radius`. plane: linear along `plane_angle`, from `value` to `edge_value`."},
        K{"value", &SpotSpec::value, kLightLevel, "sensor counts", "Light level; levels of several lamps add up."},
        K{"edge_value", &SpotSpec::edge_value, kLightLevel, "sensor counts",
          "gradient and plane: level at the far side."}
            .only_if(has_edge),
        K{"gradient_radius", &SpotSpec::gradient_radius_mm, kCoordinate, "mm",
          "gradient: where `edge_value` is reached; 0 or less: the largest distance inside the shape."}
            .only_if(is_gradient),
        K{"plane_angle", &SpotSpec::plane_angle_rad, kAngle, "rad",
          "plane: direction of the normal, clockwise on the screen from +x."}
            .only_if(is_plane),
        K{"plane_half_span", &SpotSpec::plane_half_span_mm, kLength, "mm",
          "plane: distance from the centre at which `value` (behind) and `edge_value` (ahead) are reached."}
            .only_if(is_plane),
        K{"photo_start_at", &SpotSpec::photo_start_at_s, kStartTime, "s",
          "At 0 or later: dark before, then a flash, then the normal light. Negative: no flash."},
        K{"photo_start_duration", &SpotSpec::photo_start_duration_s, kSeconds, "s", "Length of the flash."}.only_if(
            has_photo_start),
        K{"photo_start_value", &SpotSpec::photo_start_value, kLightLevel, "sensor counts", "Level of the flash."}
            .only_if(has_photo_start),
    };
    return keys;
}

}  // namespace

std::span<Key<Vec2> const> lighthouse_centre_keys() {
    using K = Key<Vec2>;
    static std::array const keys{
        K{"x", &Vec2::x, kCoordinate, "mm",
          "Centre; with `geometry` global or arena it counts from the centre of the arena's bounding box."},
        K{"y", &Vec2::y, kCoordinate, "mm", "See x."},
    };
    return keys;
}

void read_spot(MapReader& reader, SpotSpec& spot) {
    reader.read(spot_keys(), spot);
    if (is_everywhere(spot.shape) && spot.mode == LightMode::uniform) {
        reader.read_unused(spot_centre_keys(), spot.centre_mm);
    } else {
        reader.read(spot_centre_keys(), spot.centre_mm);
    }
}

}  // namespace pogosim
