#include "device/link_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "world/link_places.hpp"

namespace pogosim {

namespace {

constexpr float kMostGapMm = 1.0F;  // by which a rod or hinge may miss its ends
constexpr float kMostReachMm = 1e6F;
constexpr float kMostLimitRad = 6.2832F;

/// The body that a link may hold.
std::uint32_t body_to_link(World const& world, std::uint32_t object) {
    if (object >= world.objects.size()) {
        throw ConfigError(fmt::format("there is no object {}: the run has {}", object, world.objects.size()));
    }
    Object const& found = world.objects[object];
    std::string const& category = world.categories[found.category].name;
    if (found.body == kNone) {
        throw ConfigError(fmt::format("object {} of category '{}' has no body that could be linked", object, category));
    }
    if (found.body_count > 1) {
        throw ConfigError(
            fmt::format("object {} of category '{}' is a membrane, which cannot be linked", object, category));
    }
    return found.body;
}

void check_objects(World const& world, std::uint32_t a, std::uint32_t b) {
    std::uint32_t const body_a = body_to_link(world, a);
    if (a == b) {
        throw ConfigError(fmt::format("object {} cannot be linked to itself", a));
    }
    bool const b_is_fixed = b == kNone || world.bodies.spec[body_to_link(world, b)].fixed;
    if (world.bodies.spec[body_a].fixed && b_is_fixed) {
        throw ConfigError(b == kNone ? fmt::format("object {} is fixed: a link to the arena would hold nothing", a)
                                     : fmt::format("objects {} and {} are fixed: a link would hold nothing", a, b));
    }
}

void check_range(char const* name, float value, float least, float most, char const* expected) {
    if (!(value >= least && value <= most)) {
        throw ConfigError(fmt::format("{}: expected {}, found {:g}", name, expected, value));
    }
}

void check_end(char const* name, Vec2 end_mm) {
    if (!(std::abs(end_mm.x) <= kMostReachMm && std::abs(end_mm.y) <= kMostReachMm)) {
        throw ConfigError(fmt::format("{}: expected finite numbers up to {:g}, found ({:g}, {:g})", name, kMostReachMm,
                                      end_mm.x, end_mm.y));
    }
}

void check_numbers(NewLink const& link) {
    constexpr float largest = 1e9F;
    constexpr float infinite = std::numeric_limits<float>::infinity();
    bool const is_spring = link.kind == LinkKind::spring;
    bool const is_hinge = link.kind == LinkKind::hinge;
    check_end("end_a", link.end_a_mm);
    check_end("end_b", link.end_b_mm);
    check_range("length", link.length_mm.value_or(0.0F), 0.0F, kMostReachMm, "a number from 0 to 1e+06");
    check_range("stiffness", link.stiffness_n_m, 0.0F, is_spring ? largest : 0.0F,
                is_spring ? "a number from 0 to 1e+09" : "0, as only springs have one");
    check_range("damping", link.damping_n_s_m, 0.0F, is_spring ? largest : 0.0F,
                is_spring ? "a number from 0 to 1e+09" : "0, as only springs have one");
    if (is_spring && link.stiffness_n_m == 0.0F && link.damping_n_s_m == 0.0F) {
        throw ConfigError("stiffness: a spring without stiffness and damping would do nothing");
    }
    check_range("breaking force", link.breaking_n, std::numeric_limits<float>::denorm_min(), infinite,
                "a number above 0");
    bool const is_limited = link.least_rad != -infinite || link.most_rad != infinite;
    if (is_limited && !is_hinge) {
        throw ConfigError("limits: only hinges have some");
    }
    check_range("least angle", link.least_rad, -infinite, 0.0F, "a number of at most 0");
    check_range("greatest angle", link.most_rad, 0.0F, infinite, "a number of at least 0");
    for (float const limit_rad : {link.least_rad, link.most_rad}) {
        if (std::isfinite(limit_rad) && std::abs(limit_rad) > kMostLimitRad) {
            throw ConfigError(fmt::format("limits: expected angles in rad, up to 2 pi, found {:g}", limit_rad));
        }
    }
}

/// The length at rest of a link whose ends are so far apart now.
float length_of(NewLink const& link, float distance_mm) {
    if (link.kind == LinkKind::hinge) {
        if (link.length_mm.value_or(0.0F) != 0.0F) {
            throw ConfigError("length: a hinge has none");
        }
        if (distance_mm > kMostGapMm) {
            throw ConfigError(
                fmt::format("the ends of a hinge have to be in one place, and these are {:g} mm apart", distance_mm));
        }
        return 0.0F;
    }
    float const length_mm = link.length_mm.value_or(distance_mm);
    if (link.kind == LinkKind::rod && length_mm <= 0.0F) {
        throw ConfigError("length: expected a number above 0 for a rod, found 0; a hinge holds two ends together");
    }
    if (link.kind == LinkKind::rod && std::abs(length_mm - distance_mm) > kMostGapMm) {
        throw ConfigError(
            fmt::format("length: a rod of {:g} mm does not fit ends that are {:g} mm apart", length_mm, distance_mm));
    }
    return length_mm;
}

float heading_of(World const& world, std::uint32_t body) {
    return body == kNone ? 0.0F : world.bodies.heading_rad[body];
}

/// Index of the category of links that are made during a run.
std::uint32_t made_category(World& world) {
    auto const found = std::ranges::find(world.link_categories, kMadeLinks, &LinkCategory::name);
    auto const index = static_cast<std::uint32_t>(found - world.link_categories.begin());
    if (found == world.link_categories.end()) {
        world.link_categories.push_back({.name = kMadeLinks});
    }
    return index;
}

}  // namespace

NewLink link_between(World const& world, LinkKind kind, std::uint32_t a, std::uint32_t b) {
    check_objects(world, a, b);
    Bodies const& bodies = world.bodies;
    std::uint32_t const body_a = world.objects[a].body;
    NewLink link{.kind = kind, .a = a, .b = b, .end_a_mm = {}, .end_b_mm = {}};
    if (b == kNone) {
        link.end_b_mm = wrapped(world, bodies.position_mm[body_a]);
    } else if (kind == LinkKind::hinge) {
        std::uint32_t const body_b = world.objects[b].body;
        Vec2 const half = 0.5F * minimum_image(world, bodies.position_mm[body_a], bodies.position_mm[body_b]);
        link.end_a_mm = in_frame_of(bodies, body_a, half);
        link.end_b_mm = in_frame_of(bodies, body_b, -half);
    }
    return link;
}

std::uint32_t add_link(World& world, NewLink const& link) {
    check_objects(world, link.a, link.b);
    check_numbers(link);
    Link made{.kind = link.kind,
              .a = world.objects[link.a].body,
              .b = link.b == kNone ? kNone : world.objects[link.b].body,
              .end_a_mm = link.end_a_mm,
              .end_b_mm = link.end_b_mm,
              .length_mm = 0.0F,
              .stiffness_n_m = link.stiffness_n_m,
              .damping_n_s_m = link.damping_n_s_m,
              .breaking_n = link.breaking_n,
              .least_rad = link.least_rad,
              .most_rad = link.most_rad};
    made.length_mm = length_of(link, length(places_of_ends(world, made).span_mm()));
    made.rest_rad =
        made.kind == LinkKind::hinge ? wrap_angle(heading_of(world, made.b) - heading_of(world, made.a)) : 0.0F;
    made.link_category = made_category(world);
    world.links.push_back(made);
    ++world.link_changes;
    return static_cast<std::uint32_t>(world.links.size() - 1);
}

Link const& link_at(World const& world, std::size_t link) {
    std::size_t const count = world.links.size();
    if (link >= count) {
        throw ConfigError(
            count == 0 ? fmt::format("there is no link {}: the run has none", link)
                       : fmt::format("there is no link {}: the run has {}, from 0 to {}", link, count, count - 1));
    }
    return world.links[link];
}

void cut_link(World& world, std::size_t link) {
    if (!link_at(world, link).is_cut) {
        world.links[link].is_cut = true;
        world.links[link].tension_n = 0.0F;
        ++world.link_changes;
    }
}

std::uint32_t object_of_body(World const& world, std::uint32_t body) {
    auto const has_body = [body](Object const& object) {
        return object.body != kNone && body >= object.body && body - object.body < object.body_count;
    };
    auto const found = body == kNone ? world.objects.end() : std::ranges::find_if(world.objects, has_body);
    return found == world.objects.end() ? kNone : static_cast<std::uint32_t>(found - world.objects.begin());
}

std::vector<std::uint32_t> objects_of_bodies(World const& world) {
    std::vector<std::uint32_t> objects(world.bodies.size(), kNone);
    for (std::uint32_t i = 0; i < world.objects.size(); ++i) {
        Object const& object = world.objects[i];
        if (object.body != kNone) {
            std::fill_n(objects.begin() + object.body, object.body_count, i);
        }
    }
    return objects;
}

}  // namespace pogosim
