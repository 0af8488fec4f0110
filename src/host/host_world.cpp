// pogosim/host.h: objects, lamps and columns of a run.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "base/error.hpp"
#include "device/sensing.hpp"
#include "device/world_edit.hpp"
#include "host/hosted_run.hpp"
#include "host/status.hpp"
#include "pogosim/host.h"

using namespace pogosim;

namespace {

Object const& object_at(World const& world, std::size_t object) {
    if (object >= world.objects.size()) {
        throw ConfigError(fmt::format("there is no object {}: the run has {}", object, world.objects.size()));
    }
    return world.objects[object];
}

PlacedLamp const& lamp_at(World const& world, std::size_t lamp) {
    if (lamp >= world.lamps.size()) {
        throw ConfigError(fmt::format("there is no lamp {}: the run has {}", lamp, world.lamps.size()));
    }
    return world.lamps[lamp];
}

float number(char const* name, double value, double smallest) {
    constexpr double largest = std::numeric_limits<float>::max();
    if (!(value >= smallest && value <= largest)) {
        throw ConfigError(fmt::format("{}: expected a finite number{}, found {}", name,
                                      smallest == 0.0 ? " of at least 0" : "", value));
    }
    return static_cast<float>(value);
}

}  // namespace

int pogosim_run_object(pogosim_run const* run, size_t object, pogosim_object* found) {
    return with_status_of(*run, [&] {
        World const& world = run->simulation().world();
        Object const& of = object_at(world, object);
        auto const [place_mm, heading_rad] = pose_of(world, of);
        bool const runs_program = of.robot != kNone;
        *found = {.id = of.id,
                  .category = of.category,
                  .robot = of.robot,
                  .is_alive = !runs_program || is_alive(world, of.robot) ? 1 : 0,
                  .x_mm = place_mm.x,
                  .y_mm = place_mm.y,
                  .heading_rad = heading_rad,
                  .light = light_of(world, of)};
        return POGOSIM_OK;
    });
}

int pogosim_run_set_object_pose(pogosim_run* run, size_t object, double x_mm, double y_mm, double heading_rad) {
    return with_status_of(*run, [&] {
        World const& world = run->simulation().world();
        Object const& moved = object_at(world, object);
        Vec2 const place_mm{static_cast<float>(x_mm), static_cast<float>(y_mm)};
        if (!run->simulation().set_pose(static_cast<std::uint32_t>(object), place_mm,
                                        static_cast<float>(heading_rad))) {
            throw ConfigError(fmt::format("object {} of category '{}' has no body that could be moved", object,
                                          world.categories[moved.category].name));
        }
        return POGOSIM_OK;
    });
}

int pogosim_run_drag_object(pogosim_run* run, size_t object, double x_mm, double y_mm, int* is_moved) {
    return with_status_of(*run, [&] {
        *is_moved = 0;
        World const& world = run->simulation().world();
        Object const& dragged = object_at(world, object);
        if (dragged.body == kNone) {
            throw ConfigError(fmt::format("object {} of category '{}' has no body that could be moved", object,
                                          world.categories[dragged.category].name));
        }
        if (!(std::abs(x_mm) <= kMaxLength && std::abs(y_mm) <= kMaxLength)) {
            throw ConfigError(
                fmt::format("expected finite numbers (mm) up to {:g}, found ({:g}, {:g})", kMaxLength, x_mm, y_mm));
        }
        if (run->has_ended()) {
            throw ConfigError("the run has ended: reset it, and its objects can be moved again");
        }
        Vec2 const place_mm{static_cast<float>(x_mm), static_cast<float>(y_mm)};
        *is_moved = run->simulation().move_object(static_cast<std::uint32_t>(object), place_mm) ? 1 : 0;
        return POGOSIM_OK;
    });
}

int pogosim_run_set_alive(pogosim_run* run, size_t object, int alive) {
    return with_status_of(*run, [&] {
        World const& world = run->simulation().world();
        Object const& of = object_at(world, object);
        if (of.robot == kNone) {
            throw ConfigError(
                fmt::format("object {} of category '{}' runs no program", object, world.categories[of.category].name));
        }
        run->simulation().set_alive(of.robot, alive != 0);
        return POGOSIM_OK;
    });
}

int pogosim_run_lamp(pogosim_run const* run, size_t lamp, pogosim_lamp* found) {
    return with_status_of(*run, [&] {
        PlacedLamp const& of = lamp_at(run->simulation().world(), lamp);
        Vec2 const place_mm = of.place_mm();
        *found = {.category = of.category.c_str(),
                  .is_on = of.setting.is_on ? 1 : 0,
                  .intensity = of.setting.intensity,
                  .x_mm = place_mm.x,
                  .y_mm = place_mm.y};
        return POGOSIM_OK;
    });
}

int pogosim_run_set_lamp(pogosim_run* run, size_t lamp, pogosim_lamp const* setting) {
    return with_status_of(*run, [&] {
        constexpr double lowest = std::numeric_limits<float>::lowest();
        PlacedLamp const& of = lamp_at(run->simulation().world(), lamp);
        Vec2 const place_mm{number("x", setting->x_mm, lowest), number("y", setting->y_mm, lowest)};
        LampSetting changed = moved_to(of, place_mm);
        changed.is_on = setting->is_on != 0;
        changed.intensity = number("intensity", setting->intensity, 0.0);
        run->simulation().set_lamp(lamp, changed);
        return POGOSIM_OK;
    });
}

int pogosim_run_set_column(pogosim_run* run, int64_t object, char const* name, double value) {
    return with_status_of(*run, [&] {
        std::optional<std::uint32_t> of;
        if (object >= 0) {
            object_at(run->simulation().world(), static_cast<std::size_t>(object));
            of = static_cast<std::uint32_t>(object);
        }
        run->simulation().set_column(of, name, value);
        return POGOSIM_OK;
    });
}
