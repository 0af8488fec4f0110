#include "sim/lamps_of.hpp"

#include <string>
#include <variant>

#include "base/log.hpp"

namespace pogosim {

namespace {

bool is_between(float low, float value, float high) {
    constexpr float kMarginMm = 1.0F;  // a scaled arena may be a little smaller than meant
    return value >= low - kMarginMm && value <= high + kMarginMm;
}

void warn_outside(Scenario const& scenario, ObjectConfig const& object, std::string const& axis, Vec2 centre_mm,
                  Arena const& arena) {
    // The key that says where: center_x of an orbit, else x.
    Node const* const entry = node_of(scenario, object);
    bool const is_orbit = entry != nullptr && entry->find("center_" + axis) != nullptr;
    log().warn(
        "{}: the lamp's centre ({:g}, {:g}) is outside of {}; coordinates of older configurations may need "
        "'arena_stretch: true'",
        where_in_object(scenario, object, is_orbit ? "center_" + axis : axis), centre_mm.x, centre_mm.y,
        arena_text(arena));
}

void look_whether_in_arena(Scenario const& scenario, ObjectConfig const& object, SpotSpec const& spot,
                           Arena const& arena) {
    Box const& bounds = arena.bounds;
    if (!is_between(bounds.min.x, spot.centre_mm.x, bounds.max.x)) {
        warn_outside(scenario, object, "x", spot.centre_mm, arena);
    } else if (!is_between(bounds.min.y, spot.centre_mm.y, bounds.max.y)) {
        warn_outside(scenario, object, "y", spot.centre_mm, arena);
    }
}

}  // namespace

std::vector<LampSpec> lamps_of(Scenario const& scenario, Arena const& arena) {
    std::vector<LampSpec> lamps;
    for (ObjectConfig const& object : scenario.objects) {
        if (!object.spec.lamp) {
            continue;
        }
        LampSpec const& lamp = *object.spec.lamp;
        auto const* const spot = std::get_if<SpotSpec>(&lamp);
        if (object.nb > 0 && spot != nullptr && !is_everywhere(spot->shape)) {
            look_whether_in_arena(scenario, object, *spot, arena);
        }
        lamps.insert(lamps.end(), static_cast<std::size_t>(object.nb), lamp);
    }
    return lamps;
}

LampArea area_at_start(LampSpec const& lamp) {
    LampArea area = std::visit([](auto const& spec) { return LampArea{spec.shape, spec.centre_mm}; }, lamp);
    if (auto const* const spot = std::get_if<SpotSpec>(&lamp)) {
        area.centre_mm = area.centre_mm + spot->orbit.radius_mm * direction(static_cast<float>(spot->orbit.phase_rad));
    }
    return area;
}

}  // namespace pogosim
