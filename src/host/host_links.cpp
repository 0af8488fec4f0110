// pogosim/host.h: links between bodies of a run.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "base/error.hpp"
#include "base/narrowed.hpp"
#include "device/link_edit.hpp"
#include "host/hosted_run.hpp"
#include "host/link_kind.hpp"
#include "host/status.hpp"
#include "pogosim/host.h"
#include "world/link_places.hpp"

using namespace pogosim;

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::int32_t kind_of(LinkKind kind) {
    switch (kind) {
        case LinkKind::spring:
            return POGOSIM_RUN_SPRING;
        case LinkKind::rod:
            return POGOSIM_RUN_ROD;
        case LinkKind::hinge:
            break;
    }
    return POGOSIM_RUN_HINGE;
}

Vec2 point(double const (&mm)[2]) {
    return {narrowed(mm[0]), narrowed(mm[1])};
}

/// -1: none, which is the arena.
std::uint32_t object_of(std::int64_t index) {
    if (index < -1 || index >= kNone) {
        throw ConfigError(fmt::format("expected the index of an object, or -1 for the arena; found {}", index));
    }
    return index < 0 ? kNone : static_cast<std::uint32_t>(index);
}

std::int32_t robot_of(World const& world, std::vector<std::uint32_t> const& objects, std::uint32_t body) {
    std::uint32_t const robot = body == kNone ? kNone : world.objects[objects[body]].robot;
    return robot == kNone ? -1 : static_cast<std::int32_t>(robot);
}

pogosim_run_link described(World const& world, Link const& link, std::vector<std::uint32_t> const& objects) {
    return {.kind = kind_of(link.kind),
            .a = static_cast<std::int32_t>(objects[link.a]),
            .b = link.b == kNone ? -1 : static_cast<std::int32_t>(objects[link.b]),
            .robot_a = robot_of(world, objects, link.a),
            .robot_b = robot_of(world, objects, link.b),
            .is_cut = link.is_cut ? 1 : 0,
            .end_a_mm = {link.end_a_mm.x, link.end_a_mm.y},
            .end_b_mm = {link.end_b_mm.x, link.end_b_mm.y},
            .rest_mm = link.length_mm,
            .stiffness_n_m = link.stiffness_n_m,
            .damping_n_s_m = link.damping_n_s_m,
            .breaking_n = link.breaking_n,
            .least_rad = link.least_rad,
            .most_rad = link.most_rad,
            .length_mm = length(places_of_ends(world, link).span_mm()),
            .tension_n = link.tension_n};
}

}  // namespace

int pogosim_run_links(pogosim_run const* run, pogosim_run_link* links, size_t room, size_t* count) {
    return with_status_of(*run, [&] {
        World const& world = run->simulation().world();
        *count = world.links.size();
        std::vector<std::uint32_t> const objects = objects_of_bodies(world);
        for (std::size_t i = 0; i < std::min(room, world.links.size()); ++i) {
            links[i] = described(world, world.links[i], objects);
        }
        return POGOSIM_OK;
    });
}

int pogosim_run_new_link(pogosim_run const* run, int32_t kind, size_t a, int64_t b, pogosim_run_link* link) {
    return with_status_of(*run, [&] {
        World const& world = run->simulation().world();
        NewLink const made = link_between(world, link_kind_of(kind, "kind: expected"),
                                          object_of(static_cast<std::int64_t>(a)), object_of(b));
        *link = {.kind = kind,
                 .a = static_cast<std::int32_t>(made.a),
                 .b = made.b == kNone ? -1 : static_cast<std::int32_t>(made.b),
                 .robot_a = -1,
                 .robot_b = -1,
                 .is_cut = 0,
                 .end_a_mm = {made.end_a_mm.x, made.end_a_mm.y},
                 .end_b_mm = {made.end_b_mm.x, made.end_b_mm.y},
                 .rest_mm = std::numeric_limits<double>::quiet_NaN(),
                 .stiffness_n_m = 0.0,
                 .damping_n_s_m = 0.0,
                 .breaking_n = kInfinite,
                 .least_rad = -kInfinite,
                 .most_rad = kInfinite,
                 .length_mm = 0.0,
                 .tension_n = 0.0};
        return POGOSIM_OK;
    });
}

int pogosim_run_add_link(pogosim_run* run, pogosim_run_link const* link, size_t* index) {
    return with_status_of(*run, [&] {
        NewLink made{
            .kind = link_kind_of(link->kind, "kind: expected"), .a = object_of(link->a), .b = object_of(link->b)};
        made.end_a_mm = point(link->end_a_mm);
        made.end_b_mm = point(link->end_b_mm);
        if (!std::isnan(link->rest_mm)) {
            made.length_mm = narrowed(link->rest_mm);
        }
        made.stiffness_n_m = narrowed(link->stiffness_n_m);
        made.damping_n_s_m = narrowed(link->damping_n_s_m);
        made.breaking_n = narrowed(link->breaking_n);
        made.least_rad = narrowed(link->least_rad);
        made.most_rad = narrowed(link->most_rad);
        *index = run->simulation().add_link(made);
        return POGOSIM_OK;
    });
}

int pogosim_run_cut_links(pogosim_run* run, uint32_t const* links, size_t count) {
    return with_status_of(*run, [&] {
        run->simulation().cut_links({links, count});
        return POGOSIM_OK;
    });
}
