// pogosim/host.h: what a viewer of a run shows.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "base/escaped.hpp"
#include "host/hosted_run.hpp"
#include "host/status.hpp"
#include "pogosim/host.h"

using namespace pogosim;

namespace {

std::string metadata_as_json(Simulation const& simulation) {
    std::vector<std::string> entries;
    for (auto const& [key, value] : simulation.metadata()) {
        entries.push_back(fmt::format("{}:{}", json_text(key), json_text(value)));
    }
    return fmt::format("{{{}}}", fmt::join(entries, ","));
}

bool is_membrane(Object const& object) {
    return object.body_count > 1;
}

void copy_poses(World const& world, float* poses) {
    for (Object const& object : world.objects) {
        Pose const pose = pose_of(world, object);
        *poses++ = pose.position_mm.x;
        *poses++ = pose.position_mm.y;
        *poses++ = is_membrane(object) ? std::numeric_limits<float>::quiet_NaN() : pose.heading_rad;
    }
}

void copy_leds(World const& world, std::uint32_t* led_rgb) {
    for (Object const& object : world.objects) {
        if (object.robot == kNone) {
            *led_rgb++ = kNone;
            continue;
        }
        Rgb const head = world.robots.led[object.robot][0];
        *led_rgb++ = static_cast<std::uint32_t>(head.r << 16 | head.g << 8 | head.b);
    }
}

/// Calls visit(object, body) for each part of a membrane.
template <class Visit>
void for_each_part(World const& world, Visit const& visit) {
    for (std::uint32_t i = 0; i < world.objects.size(); ++i) {
        Object const& object = world.objects[i];
        for (std::uint32_t part = 0; is_membrane(object) && part < object.body_count; ++part) {
            visit(i, object.body + part);
        }
    }
}

void copy_parts(World const& world, float* parts_mm) {
    for_each_part(world, [&](std::uint32_t, std::uint32_t body) {
        Vec2 const place_mm = wrapped(world, world.bodies.position_mm[body]);
        *parts_mm++ = place_mm.x;
        *parts_mm++ = place_mm.y;
    });
}

void copy_owners(World const& world, std::uint32_t* parts_of) {
    for_each_part(world, [&](std::uint32_t object, std::uint32_t) { *parts_of++ = object; });
}

}  // namespace

std::size_t pogosim::part_count(World const& world) {
    std::size_t count = 0;
    for_each_part(world, [&](std::uint32_t, std::uint32_t) { ++count; });
    return count;
}

char const* pogosim_run_metadata(pogosim_run const* run) {
    std::lock_guard const lock(run->in_use);
    if (run->metadata.empty()) {
        run->metadata = metadata_as_json(run->simulation());
    }
    return run->metadata.c_str();
}

int pogosim_run_look(pogosim_run const* run, pogosim_view* view) {
    return with_status_of(*run, [&] {
        World const& world = run->simulation().world();
        view->time_s = world.time_s();
        view->step = static_cast<std::int64_t>(world.step);
        if (view->poses != nullptr) {
            copy_poses(world, view->poses);
        }
        if (view->led_rgb != nullptr) {
            copy_leds(world, view->led_rgb);
        }
        if (view->parts_mm != nullptr) {
            copy_parts(world, view->parts_mm);
        }
        if (view->parts_of != nullptr) {
            copy_owners(world, view->parts_of);
        }
        return POGOSIM_OK;
    });
}
