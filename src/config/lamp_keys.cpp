#include "config/lamp_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <vector>

#include "base/log.hpp"
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
        K{"value", &SpotSpec::value, kLightLevel, "sensor counts", "Light level; the levels of several lamps add up."},
        K{"edge_value", &SpotSpec::edge_value, kLightLevel, "sensor counts",
          "gradient and plane: level at the far side."}
            .only_if(has_edge),
        K{"gradient_radius", &SpotSpec::gradient_radius_mm, kCoordinate, "mm",
          "gradient: distance from the centre at which `edge_value` is reached; 0 or less: the largest distance inside "
          "the shape."}
            .only_if(is_gradient),
        K{"plane_angle", &SpotSpec::plane_angle_rad, kAngle, "rad",
          "plane: direction of the normal, clockwise on the screen from +x."}
            .only_if(is_plane),
        K{"plane_half_span", &SpotSpec::plane_half_span_mm, kLength, "mm",
          "plane: distance from the centre at which `value` (behind) and `edge_value` (ahead) are reached."}
            .only_if(is_plane),
        K{"photo_start_at", &SpotSpec::photo_start_at_s, kStartTime, "s",
          "Time of a flash; dark before it, normal light after it. Negative: no flash."},
        K{"photo_start_duration", &SpotSpec::photo_start_duration_s, kSeconds, "s", "Duration of the flash."}.only_if(
            has_photo_start),
        K{"photo_start_value", &SpotSpec::photo_start_value, kLightLevel, "sensor counts", "Level of the flash."}
            .only_if(has_photo_start),
    };
    return keys;
}

/// Warns of keys of a gradient or a plane if light_mode does not ask for one.
void warn_without_mode(MapReader const& reader) {
    std::vector<std::string_view> given;
    for (std::string_view const key : {"edge_value", "gradient_radius", "plane_angle", "plane_half_span"}) {
        if (reader.find(key) != nullptr) {
            given.push_back(key);
        }
    }
    if (reader.find("light_mode") == nullptr && !given.empty()) {
        log().warn("{}: {}: {} no effect with light_mode static, the default; set light_mode to gradient or plane",
                   reader.find(given.front())->where(), reader.place().path,
                   fmt::format("{} {}", fmt::join(given, ", "), given.size() == 1 ? "has" : "have"));
    }
}

}  // namespace

std::span<Key<Vec2> const> lighthouse_centre_keys() {
    using K = Key<Vec2>;
    static std::array const keys{
        K{"x", &Vec2::x, kCoordinate, "mm",
          "Centre; with `geometry` global or arena, relative to the centre of the arena's bounding box."},
        K{"y", &Vec2::y, kCoordinate, "mm", "See x."},
    };
    return keys;
}

void warn_of_lone_coordinate(MapReader const& reader, std::string_view x, std::string_view y, Vec2 centre_mm) {
    if (auto const lone = reader.lone_key(x, y)) {
        log().warn("{}: {}: {} without {}; {} is {:g}. Specify both", reader.find(lone->given)->where(),
                   reader.path_of(lone->given), lone->given, lone->missing, lone->missing,
                   lone->missing == y ? centre_mm.y : centre_mm.x);
    }
}

void read_spot(MapReader& reader, SpotSpec& spot) {
    reader.read(spot_keys(), spot);
    warn_without_mode(reader);
    if (is_everywhere(spot.shape) && spot.mode == LightMode::uniform) {
        reader.read_unused(spot_centre_keys(), spot.centre_mm);
    } else {
        reader.read(spot_centre_keys(), spot.centre_mm);
    }
}

}  // namespace pogosim
