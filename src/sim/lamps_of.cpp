#include "sim/lamps_of.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>

#include "base/log.hpp"
#include "config/places.hpp"
#include "lamps/spot_lamp.hpp"
#include "light/lit_area.hpp"

namespace pogosim {

namespace {

bool is_between(float low, float value, float high) {
    constexpr float kMarginMm = 1.0F;  // a scaled arena may be slightly smaller than intended
    return value >= low - kMarginMm && value <= high + kMarginMm;
}

void warn_outside(Scenario const& scenario, ObjectConfig const& object, ObjectSetting axis, Vec2 centre_mm,
                  Arena const& arena) {
    log().warn(
        "{}: the lamp's centre ({:g}, {:g}) is outside {}; coordinates of older configurations may need "
        "'arena_stretch: true'",
        place_of(scenario, object, axis), centre_mm.x, centre_mm.y, arena_text(arena));
}

/// True when the centre of the spot is in the arena's bounding box; else it warns.
bool is_in_arena(Scenario const& scenario, ObjectConfig const& object, SpotSpec const& spot, Arena const& arena) {
    Box const& bounds = arena.bounds;
    if (!is_between(bounds.min.x, spot.centre_mm.x, bounds.max.x)) {
        warn_outside(scenario, object, ObjectSetting::x, spot.centre_mm, arena);
        return false;
    }
    if (!is_between(bounds.min.y, spot.centre_mm.y, bounds.max.y)) {
        warn_outside(scenario, object, ObjectSetting::y, spot.centre_mm, arena);
        return false;
    }
    return true;
}

bool lights_a_cell(LampArea const& area, LightMap const& map) {
    bool lights = false;
    for_each_cell_in(area.shape, area.centre_mm, map, [&lights](std::uint32_t, Vec2) { lights = true; });
    return lights;
}

/// Places of the area that a lamp lights in the course of time. For an orbit: many places, those within the arena (all,
/// if it is periodic).
std::vector<LampArea> areas_of(LampSpec const& lamp, World const& world) {
    Arena const& arena = world.arena;
    LampArea const start = area_at_start(lamp);
    auto const* const spot = lamp.get_if<SpotSpec>();
    if (spot == nullptr || spot->orbit.radius_mm == 0.0F || spot->orbit.angular_speed_rad_s == 0.0) {
        return {start};
    }
    constexpr int kPlaces = 360;
    std::vector<LampArea> areas;
    for (int i = 0; i < kPlaces; ++i) {
        constexpr float turn = 2.0F * std::numbers::pi_v<float>;
        float const angle_rad = turn * static_cast<float>(i) / static_cast<float>(kPlaces);
        Vec2 const centre_mm = spot->centre_mm + spot->orbit.radius_mm * direction(angle_rad);
        bool const inside = is_between(arena.bounds.min.x, centre_mm.x, arena.bounds.max.x) &&
                            is_between(arena.bounds.min.y, centre_mm.y, arena.bounds.max.y);
        if (inside || world.periodic) {
            areas.push_back({start.shape, centre_mm});
        }
    }
    return areas;
}

/// A cell is lit if its centre is, so a small lamp that stands between the centres lights nothing.
void warn_of_dark_lamp(Scenario const& scenario, ObjectConfig const& object, World const& world) {
    LampSpec const& lamp = *object.spec.lamp;
    LightMap const& map = world.light;
    Shape const shape = area_at_start(lamp).shape;
    bool const reaches_a_centre = inner_radius(shape) >= 0.5F * length(map.cell_mm);
    if (reaches_a_centre && lamp.get_if<SpotSpec>() != nullptr) {
        return;
    }
    std::vector<LampArea> const areas = areas_of(lamp, world);
    auto const is_dark = [&map](LampArea const& area) { return !lights_a_cell(area, map); };
    auto const dark = std::ranges::count_if(areas, is_dark);
    if (dark > 0) {
        log().warn(
            "{}: the lamp lights no cell of the light map{}: it covers no cell centre, and cells measure {:.1f} mm x "
            "{:.1f} mm; enlarge the lamp, or use more cells (light_map_nb_bin_x, light_map_nb_bin_y)",
            place_of(scenario, object, ObjectSetting::size), dark < std::ssize(areas) ? " on parts of its orbit" : "",
            map.cell_mm.x, map.cell_mm.y);
    }
}

/// Lamps may overlap.
void warn_of_copies(Scenario const& scenario, ObjectConfig const& object) {
    if (object.nb > 1) {
        bool const adds_up = object.spec.lamp->adds_up();
        log().warn("{}: {} lamps at the same place{}", place_of(scenario, object, ObjectSetting::count), object.nb,
                   adds_up ? "; their levels add up" : ", which look like one");
    }
}

/// The light of a plane rises across all of a periodic arena and has to fall back somewhere: half the arena away from
/// the lamp. That is at the border when the lamp is in the middle.
void warn_of_jump(Scenario const& scenario, ObjectConfig const& object, SpotSpec const& spot, World const& world) {
    bool const has_jump =
        world.periodic && spot.mode == LightMode::plane && is_everywhere(spot.shape) && spot.value != spot.edge_value;
    if (!has_jump) {
        return;
    }
    constexpr float kSmall = 1e-3F;
    Vec2 const normal = direction(spot.plane_angle_rad);
    Vec2 const middle = world.arena.bounds.centre();
    Vec2 const jump = wrapped(world, spot.centre_mm + 0.5F * world.arena.bounds.size());
    auto const warn = [&](ObjectSetting axis, char const* name, float place_mm, float middle_mm) {
        log().warn(
            "{}: the light of a plane cannot go on across the borders of a periodic arena: it jumps at {} = {:.4g} mm, "
            "half the arena away from the lamp. With {}: {:.4g}, it would jump at the border",
            place_of(scenario, object, axis), name, place_mm, name, middle_mm);
    };
    if (std::abs(normal.x) > kSmall && !is_between(middle.x, spot.centre_mm.x, middle.x)) {
        warn(ObjectSetting::x, "x", jump.x, middle.x);
    }
    if (std::abs(normal.y) > kSmall && !is_between(middle.y, spot.centre_mm.y, middle.y)) {
        warn(ObjectSetting::y, "y", jump.y, middle.y);
    }
}

void look_for_slips(Scenario const& scenario, ObjectConfig const& object, World const& world) {
    LampSpec const& lamp = *object.spec.lamp;
    warn_of_copies(scenario, object);
    auto const* const spot = lamp.get_if<SpotSpec>();
    if (spot != nullptr && object.nb > 0) {
        warn_of_jump(scenario, object, *spot, world);
    }
    if (object.nb == 0 || is_everywhere(area_at_start(lamp).shape)) {
        return;
    }
    if (spot == nullptr || is_in_arena(scenario, object, *spot, world.arena)) {
        warn_of_dark_lamp(scenario, object, world);
    }
}

}  // namespace

std::vector<LampSpec> lamps_of(Scenario const& scenario, World const& world) {
    std::vector<LampSpec> lamps;
    for (ObjectConfig const& object : scenario.objects) {
        if (object.spec.lamp) {
            look_for_slips(scenario, object, world);
            lamps.insert(lamps.end(), static_cast<std::size_t>(object.nb), *object.spec.lamp);
        }
    }
    return lamps;
}

std::vector<PlacedLamp> placed_lamps(Scenario const& scenario, Arena const& arena) {
    std::vector<PlacedLamp> lamps;
    for (ObjectConfig const& object : scenario.objects) {
        if (object.spec.lamp) {
            LampSpec const& spec = *object.spec.lamp;
            Vec2 const start_mm =
                spec.adds_up() ? spec.centre_mm() : lit_box(spec.shape(), spec.centre_mm(), arena).centre();
            PlacedLamp const lamp{.category = object.category, .start_mm = start_mm, .setting = {}};
            lamps.insert(lamps.end(), static_cast<std::size_t>(object.nb), lamp);
        }
    }
    return lamps;
}

LampArea area_at_start(LampSpec const& lamp) {
    return {lamp.shape(), lamp.start_mm()};
}

}  // namespace pogosim
