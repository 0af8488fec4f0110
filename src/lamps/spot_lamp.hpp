// Spots of light: static_light and orbiting_static_light.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "base/log.hpp"
#include "config/lamp_keys.hpp"
#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/shape_keys.hpp"
#include "light/lamp.hpp"
#include "light/lit_area.hpp"

namespace pogosim {

enum class LightMode { uniform, gradient, plane };

/// A circle along which a lamp moves.
struct Orbit {
    float radius_mm = 0.0F;            // 0: the lamp stands still in the centre
    double angular_speed_rad_s = 0.0;  // > 0: clockwise on the screen
    double phase_rad = 0.0;            // where on the circle at time 0, from +x

    friend bool operator==(Orbit const&, Orbit const&) = default;
};

/// A spot of light, which adds to that of other lamps: `static_light`, `orbiting_static_light`.
struct SpotSpec {
    Shape shape;
    Vec2 centre_mm;  // where the lamp stands, or the centre of its orbit
    Orbit orbit;
    LightMode mode = LightMode::uniform;
    int value = 10;                    // sensor counts, 0 to 32767
    int edge_value = 0;                // gradient, plane: value at the far side
    float gradient_radius_mm = -1.0F;  // <= 0: largest distance inside the shape
    float plane_angle_rad = 0.0F;      // direction of the plane's normal
    float plane_half_span_mm = 1000.0F;
    float photo_start_at_s = -1.0F;  // >= 0: dark before, flash of photo_start_value, then normal
    float photo_start_duration_s = 1.0F;
    int photo_start_value = 32767;

    static constexpr bool kAddsUp = true;
    Vec2 start_mm() const { return centre_mm + orbit.radius_mm * direction(static_cast<float>(orbit.phase_rad)); }
    int brightest() const {
        return std::max(
            {value, mode == LightMode::uniform ? 0 : edge_value, photo_start_at_s < 0.0F ? 0 : photo_start_value});
    }
    void scale_levels(float intensity) {
        for (int* const level : {&value, &edge_value, &photo_start_value}) {
            *level = scaled_level(*level, intensity);
        }
    }

    friend bool operator==(SpotSpec const&, SpotSpec const&) = default;
};

namespace spot {

/// A lamp with a photo start is dark, then flashes, then shines as configured.
enum Phase { dark, flash, normal };

inline Phase phase_at(SpotSpec const& spec, double time_s) {
    auto const start_s = static_cast<double>(spec.photo_start_at_s);
    if (start_s < 0.0) {
        return normal;
    }
    if (time_s < start_s - kTimeToleranceS) {
        return dark;
    }
    return time_s < start_s + static_cast<double>(spec.photo_start_duration_s) - kTimeToleranceS ? flash : normal;
}

/// Also false for orbiting lamps that always look the same.
inline bool is_seen_moving(SpotSpec const& spec) {
    bool const is_same_everywhere = is_everywhere(spec.shape) && spec.mode == LightMode::uniform;
    return spec.orbit.radius_mm > 0.0F && spec.orbit.angular_speed_rad_s != 0.0 && !is_same_everywhere;
}

/// Largest distance from the lamp's centre to a point it can light.
inline float farthest_mm(Shape const& shape, Vec2 centre_mm, Box const& bounds, bool periodic) {
    if (!is_everywhere(shape)) {
        return bounding_radius(shape);
    }
    if (periodic) {
        return 0.5F * length(bounds.size());
    }
    std::array const corners{bounds.min, bounds.max, Vec2{bounds.min.x, bounds.max.y},
                             Vec2{bounds.max.x, bounds.min.y}};
    float farthest = 0.0F;
    for (Vec2 const corner : corners) {
        farthest = std::max(farthest, length(corner - centre_mm));
    }
    return farthest;
}

/// Levels from one to another as the share goes from 0 to 1, clamped outside.
class Blend {
public:
    Blend(int from, int to) : start_(static_cast<float>(from) + 0.5F), rise_(static_cast<float>(to - from)) {}

    int at(float share) const { return static_cast<int>(start_ + rise_ * std::clamp(share, 0.0F, 1.0F)); }

private:
    float start_;  // half a count more, so that cutting the fraction rounds: levels are not negative
    float rise_;
};

class SpotLamp : public Lamp {
public:
    SpotLamp(SpotSpec const& spec, Arena const& arena, LightMap const& map) : spec_(spec), bounds_(arena.bounds) {
        if (spec.shape.kind == ShapeKind::arena) {
            for (LitCell const& lit : lit_cells(spec.shape, spec.centre_mm, arena, map)) {
                arena_cells_.push_back(lit.cell);
            }
        }
    }

    Layer layer() const override { return is_seen_moving(spec_) ? Layer::moving : Layer::still; }

    LampState state_at(double time_s) const override {
        double const turned = is_seen_moving(spec_) ? spec_.orbit.angular_speed_rad_s * time_s : 0.0;
        return {.phase = phase_at(spec_, time_s),
                .angle_rad = std::remainder(spec_.orbit.phase_rad + turned, 2.0 * std::numbers::pi)};
    }

    void paint(LampState const& state, LightMap& map, std::vector<std::uint32_t>& painted) const override;

    Vec2 source_mm(LampState const& state) const override { return centre_mm(state); }

    void mark(LampState const& state, std::vector<LampMark>& marks) const override {
        if (!is_everywhere(spec_.shape) || spec_.mode == LightMode::gradient) {
            marks.push_back({.centre_mm = centre_mm(state), .shape = spec_.shape, .shape_mm = centre_mm(state)});
        }
    }

private:
    Vec2 centre_mm(LampState const& state) const {
        return spec_.centre_mm + spec_.orbit.radius_mm * direction(static_cast<float>(state.angle_rad));
    }

    template <class LevelAt>
    void add(Vec2 centre_mm, LevelAt const& level_at, LightMap& map, std::vector<std::uint32_t>& painted) const;

    SpotSpec spec_;
    Box bounds_;                              // of the arena
    std::vector<std::uint32_t> arena_cells_;  // lit ones, of lamps in the shape of the arena
};

inline void SpotLamp::paint(LampState const& state, LightMap& map, std::vector<std::uint32_t>& painted) const {
    if (state.phase == dark) {
        return;
    }
    Vec2 const centre = centre_mm(state);
    Blend const blend(spec_.value, spec_.edge_value);
    if (state.phase == flash) {
        add(
            centre, [&](Vec2) { return spec_.photo_start_value; }, map, painted);
    } else if (spec_.mode == LightMode::gradient) {
        float const radius = spec_.gradient_radius_mm > 0.0F ? spec_.gradient_radius_mm
                                                             : farthest_mm(spec_.shape, centre, bounds_, map.periodic);
        float const share_per_mm = 1.0F / radius;
        add(
            centre, [&](Vec2 offset) { return blend.at(length(offset) * share_per_mm); }, map, painted);
    } else if (spec_.mode == LightMode::plane) {
        Vec2 const share_per_mm = (0.5F / spec_.plane_half_span_mm) * direction(spec_.plane_angle_rad);
        add(
            centre, [&](Vec2 offset) { return blend.at(0.5F + dot(offset, share_per_mm)); }, map, painted);
    } else {
        add(
            centre, [&](Vec2) { return spec_.value; }, map, painted);
    }
}

template <class LevelAt>
void SpotLamp::add(Vec2 centre_mm, LevelAt const& level_at, LightMap& map, std::vector<std::uint32_t>& painted) const {
    constexpr int brightest = std::numeric_limits<std::int16_t>::max();
    bool const moves = layer() == Layer::moving;
    auto const add_to = [&](std::uint32_t cell, Vec2 point_mm) {
        int const sum = map.level[cell] + level_at(point_mm - centre_mm);
        map.level[cell] = static_cast<std::int16_t>(std::min(sum, brightest));
        if (moves) {
            painted.push_back(cell);
        }
    };
    if (spec_.shape.kind != ShapeKind::arena) {
        for_each_cell_in(spec_.shape, centre_mm, map, add_to);
        return;
    }
    for (std::uint32_t const cell : arena_cells_) {
        add_to(cell, nearest_image(map, centre_mm, cell_centre_mm(map, cell)));
    }
}

inline std::span<Key<Vec2> const> spot_centre_keys() {
    using K = Key<Vec2>;
    static std::array const keys{
        K{"x", &Vec2::x, kCoordinate, "mm", "Centre."},
        K{"y", &Vec2::y, kCoordinate, "mm", "Centre."},
    };
    return keys;
}

inline std::span<Key<SpotSpec> const> spot_keys() {
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
inline void warn_without_mode(MapReader const& reader) {
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

/// False for light that is the same wherever the lamp stands, or that one coordinate alone may place: a plane.
inline bool has_place(SpotSpec const& spot) {
    return !is_everywhere(spot.shape) || spot.mode == LightMode::gradient;
}

inline void read_spot(MapReader& reader, SpotSpec& spot) {
    reader.read(spot_keys(), spot);
    warn_without_mode(reader);
    if (is_everywhere(spot.shape) && spot.mode == LightMode::uniform) {
        reader.read_unused(spot_centre_keys(), spot.centre_mm);
    } else {
        reader.read(spot_centre_keys(), spot.centre_mm);
    }
}

inline void read_static_light(MapReader& reader, ObjectConfig& object) {
    SpotSpec spec;
    read_shape(reader, any_geometry_keys(), spec.shape);
    read_spot(reader, spec);
    if (has_place(spec)) {
        warn_of_lone_coordinate(reader, "x", "y", spec.centre_mm);
    }
    make_lamp_object(reader, object, spec, spec.mode != LightMode::plane && has_place(spec));
}

struct OrbitCentre {
    std::optional<float> x_mm;
    std::optional<float> y_mm;
};

inline std::span<Key<OrbitCentre> const> orbit_centre_keys() {
    using K = Key<OrbitCentre>;
    static std::array const keys{
        K{"center_x", &OrbitCentre::x_mm, kCoordinate, "mm", "Centre of the circle; default: `x`."},
        K{"center_y", &OrbitCentre::y_mm, kCoordinate, "mm", "Centre of the circle; default: `y`."},
    };
    return keys;
}

inline std::span<Key<Orbit> const> orbit_keys() {
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

inline void read_orbiting_static_light(MapReader& reader, ObjectConfig& object) {
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
    make_lamp_object(reader, object, spec, spec.mode != LightMode::plane && has_place(spec));
}

}  // namespace spot

inline std::shared_ptr<Lamp const> make_lamp(SpotSpec const& spec, Arena const& arena, LightMap const& map) {
    return std::make_shared<spot::SpotLamp>(spec, arena, map);
}

}  // namespace pogosim
