// world.h: what callbacks of the whole run see and change.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/narrowed.hpp"
#include "device/link_edit.hpp"
#include "device/sensing.hpp"
#include "device/switched_off.hpp"
#include "process/crash_handler.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"
#include "robot/controllers.hpp"
#include "robot/robot_floating_point.hpp"
#include "world/link_places.hpp"
#include "world/observed_motion.hpp"

using pogosim::ConfigError;
using pogosim::context;
using pogosim::DataExport;
using pogosim::kNone;
using pogosim::LampSetting;
using pogosim::Link;
using pogosim::LinkKind;
using pogosim::NewLink;
using pogosim::Object;
using pogosim::PlacedLamp;
using pogosim::require_argument;
using pogosim::require_robot;
using pogosim::RunServices;
using pogosim::Vec2;
using pogosim::without_exceptions;
using pogosim::World;

namespace {

/// Refuses the call outside the callbacks that may see the world.
void require_world(char const* function) {
    require_robot(function);
    pogosim::take_back_floating_point();
    if (!context.sees_world) {
        without_exceptions([&] {
            throw ConfigError(fmt::format(
                "{}(): robots do not see the world; call it in callback_global_setup, callback_global_step, "
                "callback_create_data_schema or callback_robot_click",
                function));
        });
    }
}

void check_index(char const* function, char const* what, std::size_t index, std::size_t count) {
    if (index < count) {
        return;
    }
    without_exceptions([&] {
        throw ConfigError(count == 0 ? fmt::format("{}(): there is no {} {}: the run has none", function, what, index)
                                     : fmt::format("{}(): there is no {} {}: the run has {}, from 0 to {}", function,
                                                   what, index, count, count - 1));
    });
}

Object const& object_at(char const* function, uint32_t object) {
    require_world(function);
    check_index(function, "object", object, context.world->objects.size());
    return context.world->objects[object];
}

/// Returns an object that runs the program; refuses others.
Object const& robot_at(char const* function, uint32_t object) {
    Object const& found = object_at(function, object);
    if (found.robot == kNone) {
        without_exceptions([&] {
            throw ConfigError(fmt::format("{}(): object {} of category '{}' runs no program", function, object,
                                          context.world->categories[found.category].name));
        });
    }
    return found;
}

PlacedLamp const& lamp_at(char const* function, uint32_t lamp) {
    require_world(function);
    check_index(function, "lamp", lamp, context.world->lamps.size());
    return context.world->lamps[lamp];
}

/// Returns the number as a float; refuses one beyond the range of a float.
float number(char const* function, char const* name, double value) {
    if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()))) {
        without_exceptions([&] {
            throw ConfigError(fmt::format("{}(): {}: expected a finite number, found {}", function, name, value));
        });
    }
    return static_cast<float>(value);
}

/// The objects of one entry of World::categories: they have been created one after the other.
std::span<Object const> objects_of(World const& world, std::uint32_t category) {
    auto const first = std::ranges::lower_bound(world.objects, category, {}, &Object::category);
    auto const end = std::ranges::upper_bound(world.objects, category, {}, &Object::category);
    return {first, end};
}

/// The object of this number, from 0, among those of a category; kNone if it has no such number. Several entries of a
/// configuration may have the same name.
std::uint32_t nth_of_category(World const& world, std::string_view name, std::size_t number) {
    for (std::uint32_t i = 0; i < world.categories.size(); ++i) {
        if (world.categories[i].name == name) {
            std::span<Object const> const objects = objects_of(world, i);
            if (number < objects.size()) {
                return static_cast<std::uint32_t>(&objects[number] - world.objects.data());
            }
            number -= objects.size();
        }
    }
    return kNone;
}

std::size_t size_of_category(World const& world, std::string_view name) {
    std::size_t size = 0;
    for (std::uint32_t i = 0; i < world.categories.size(); ++i) {
        size += world.categories[i].name == name ? objects_of(world, i).size() : 0;
    }
    return size;
}

std::string names_of_categories(World const& world) {
    std::string names;
    for (pogosim::Category const& category : world.categories) {
        names += (names.empty() ? "'" : ", '") + category.name + "'";
    }
    return names.empty() ? "none" : names;
}

/// The light as it is with the present settings of the lamps.
pogosim::LightMap const& settled_light() {
    without_exceptions([] { context.services->edit.settle_light(); });
    return context.world->light;
}

/// Changes a part of the setting of a lamp that there is.
template <class Change>
void edit_lamp(uint32_t lamp, Change const& change) {
    LampSetting setting = context.world->lamps[lamp].setting;
    change(setting);
    context.services->edit.set_lamp(*context.world, lamp, setting);
}

/// Does something with links; what they refuse is an error of the call.
template <class Do>
auto with_links(char const* function, Do const& act) {
    decltype(act()) result{};
    without_exceptions([&] {
        try {
            result = act();
        } catch (ConfigError const& error) {
            throw ConfigError(fmt::format("{}(): {}", function, error.what()));
        }
    });
    return result;
}

Link const& link_at(char const* function, uint32_t link) {
    require_world(function);
    check_index(function, "link", link, context.world->links.size());
    return context.world->links[link];
}

pogosim_link_kind_t kind_of(LinkKind kind) {
    switch (kind) {
        case LinkKind::spring:
            return POGOSIM_SPRING;
        case LinkKind::rod:
            return POGOSIM_ROD;
        case LinkKind::hinge:
            break;
    }
    return POGOSIM_HINGE;
}

LinkKind kind_of(char const* function, pogosim_link_kind_t kind) {
    switch (kind) {
        case POGOSIM_SPRING:
            return LinkKind::spring;
        case POGOSIM_ROD:
            return LinkKind::rod;
        case POGOSIM_HINGE:
            return LinkKind::hinge;
    }
    without_exceptions([&] {
        throw ConfigError(fmt::format("{}(): kind: expected POGOSIM_SPRING, POGOSIM_ROD or POGOSIM_HINGE, found {}",
                                      function, static_cast<int>(kind)));
    });
    return LinkKind::spring;
}

/// The numbers of a link as programs see them.
pogosim_link_t described(LinkKind kind, std::uint32_t a, std::uint32_t b, Vec2 end_a_mm, Vec2 end_b_mm) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    return {.kind = kind_of(kind),
            .a = a,
            .b = b,
            .a_x_mm = end_a_mm.x,
            .a_y_mm = end_a_mm.y,
            .b_x_mm = end_b_mm.x,
            .b_y_mm = end_b_mm.y,
            .length_mm = std::numeric_limits<double>::quiet_NaN(),
            .stiffness_n_m = 0.0,
            .damping_n_s_m = 0.0,
            .breaking_n = infinite,
            .least_rad = -infinite,
            .most_rad = infinite};
}

void set_column(char const* function, std::optional<uint32_t> object, char const* name, double value) {
    require_argument(name, function, "the name of the column");
    without_exceptions([&] {
        DataExport& data = context.services->data;
        if (!data.is_declared) {
            // Before the columns are declared, or in a run without a data file, which never asks for them.
            if (context.phase == pogosim::Phase::global_setup) {
                throw ConfigError(fmt::format(
                    "{}(\"{}\"): columns are declared after callback_global_setup; call it in callback_global_step, or "
                    "in callback_create_data_schema after data_add_column_*",
                    function, name));
            }
            return;
        }
        try {
            data.hold(context.world->objects.size(), object, name, value);
        } catch (ConfigError const& error) {
            throw ConfigError(fmt::format("{}(): {}", function, error.what()));
        }
    });
}

}  // namespace

double pogosim_world_time() {
    require_world(__func__);
    return context.world->time_s();
}

uint32_t pogosim_world_object_count() {
    require_world(__func__);
    return static_cast<uint32_t>(context.world->objects.size());
}

uint32_t pogosim_world_category_size(char const* category) {
    require_world(__func__);
    require_argument(category, __func__, "category");
    return static_cast<uint32_t>(size_of_category(*context.world, category));
}

uint32_t pogosim_world_object(char const* category, uint32_t number) {
    require_world(__func__);
    require_argument(category, __func__, "category");
    World const& world = *context.world;
    std::uint32_t const found = nth_of_category(world, category, number);
    if (found == kNone) {
        without_exceptions([&] {
            std::size_t const count = size_of_category(world, category);
            throw ConfigError(
                count == 0 ? fmt::format("pogosim_world_object(): no object has the category '{}'; those of the run: "
                                         "{}",
                                         category, names_of_categories(world))
                           : fmt::format("pogosim_world_object(): there is no object {} of category '{}': the run has "
                                         "{}, from 0 to {}",
                                         number, category, count, count - 1));
        });
    }
    return found;
}

char const* pogosim_world_category(uint32_t object) {
    Object const& found = object_at(__func__, object);
    return context.world->categories[found.category].name.c_str();
}

uint32_t pogosim_world_id(uint32_t object) {
    return object_at(__func__, object).id;
}

bool pogosim_world_runs_program(uint32_t object) {
    return object_at(__func__, object).robot != kNone;
}

void pogosim_world_pose(uint32_t object, pogosim_pose_t* pose) {
    Object const& found = object_at(__func__, object);
    require_argument(pose, __func__, "pose");
    auto const [place, heading] = pogosim::pose_of(*context.world, found);
    *pose = {.x_mm = place.x, .y_mm = place.y, .heading_rad = heading};
}

void pogosim_world_velocity(uint32_t object, pogosim_velocity_t* velocity) {
    Object const& found = object_at(__func__, object);
    require_argument(velocity, __func__, "velocity");
    auto const [velocity_mm_s, angular_velocity_rad_s] = pogosim::observed_motion(*context.world, found);
    *velocity = {.x_mm_s = velocity_mm_s.x, .y_mm_s = velocity_mm_s.y, .angular_rad_s = angular_velocity_rad_s};
}

bool pogosim_world_set_pose(uint32_t object, double x_mm, double y_mm, double heading_rad) {
    Object const& found = object_at(__func__, object);
    Vec2 const place{number(__func__, "x_mm", x_mm), number(__func__, "y_mm", y_mm)};
    float const heading = number(__func__, "heading_rad", heading_rad);
    bool is_moved = false;
    without_exceptions([&] { is_moved = context.services->edit.set_pose(*context.world, found, place, heading); });
    return is_moved;
}

void pogosim_world_led(uint32_t object, uint8_t led, uint8_t* r, uint8_t* g, uint8_t* b) {
    Object const& found = robot_at(__func__, object);
    require_argument(r, __func__, "r");
    require_argument(g, __func__, "g");
    require_argument(b, __func__, "b");
    if (led >= pogosim::kLedCount) {
        pogosim::refuse_user_code("pogosim_world_led(): led: expected 0 (head) to 4 (left)");
    }
    pogosim::Rgb const colour = context.world->robots.led[found.robot][led];
    *r = colour.r;
    *g = colour.g;
    *b = colour.b;
}

void* pogosim_world_user_data(uint32_t object) {
    Object const& found = object_at(__func__, object);
    RunServices& services = *context.services;
    services.gave_user_data = true;
    if (found.robot != kNone && !pogosim::needs_program(context.world->spec_of(found.robot).brain)) [[unlikely]] {
        services.warn_once(
            "pogosim_world_user_data(): another brain than this program drives object {}, which does not use this "
            "USERDATA",
            object);
    }
    return found.robot == kNone ? nullptr : services.controllers->controller_of(found.robot).user_data;
}

bool pogosim_world_is_alive(uint32_t object) {
    Object const& found = object_at(__func__, object);
    return found.robot == kNone || pogosim::is_alive(*context.world, found.robot);
}

void pogosim_world_set_alive(uint32_t object, bool alive) {
    Object const& found = robot_at(__func__, object);
    without_exceptions([&] { pogosim::set_alive(*context.world, found.robot, alive); });
}

double pogosim_world_light_at(double x_mm, double y_mm) {
    require_world(__func__);
    Vec2 const place{number(__func__, "x_mm", x_mm), number(__func__, "y_mm", y_mm)};
    return settled_light().at(pogosim::wrapped(*context.world, place));
}

double pogosim_world_light(uint32_t object) {
    Object const& found = object_at(__func__, object);
    settled_light();
    return pogosim::light_of(*context.world, found);
}

uint32_t pogosim_world_lamp_count() {
    require_world(__func__);
    return static_cast<uint32_t>(context.world->lamps.size());
}

char const* pogosim_world_lamp_category(uint32_t lamp) {
    return lamp_at(__func__, lamp).category.c_str();
}

bool pogosim_world_lamp_is_on(uint32_t lamp) {
    return lamp_at(__func__, lamp).setting.is_on;
}

void pogosim_world_set_lamp_on(uint32_t lamp, bool on) {
    lamp_at(__func__, lamp);
    edit_lamp(lamp, [on](LampSetting& setting) { setting.is_on = on; });
}

double pogosim_world_lamp_intensity(uint32_t lamp) {
    return lamp_at(__func__, lamp).setting.intensity;
}

void pogosim_world_set_lamp_intensity(uint32_t lamp, double intensity) {
    lamp_at(__func__, lamp);
    float const factor = number(__func__, "intensity", intensity);
    if (factor < 0.0F) {
        pogosim::refuse_user_code("pogosim_world_set_lamp_intensity(): intensity: expected a number of at least 0");
    }
    edit_lamp(lamp, [factor](LampSetting& setting) { setting.intensity = factor; });
}

void pogosim_world_lamp_position(uint32_t lamp, double* x_mm, double* y_mm) {
    require_world(__func__);
    require_argument(x_mm, __func__, "x_mm");
    require_argument(y_mm, __func__, "y_mm");
    PlacedLamp const& found = lamp_at(__func__, lamp);
    Vec2 const place = found.place_mm();
    *x_mm = place.x;
    *y_mm = place.y;
}

void pogosim_world_set_lamp_position(uint32_t lamp, double x_mm, double y_mm) {
    PlacedLamp const& found = lamp_at(__func__, lamp);
    Vec2 const place{number(__func__, "x_mm", x_mm), number(__func__, "y_mm", y_mm)};
    edit_lamp(lamp, [&](LampSetting& setting) { setting = moved_to(found, place); });
}

uint32_t pogosim_world_link_count() {
    require_world(__func__);
    return static_cast<uint32_t>(context.world->links.size());
}

void pogosim_world_link(uint32_t link, pogosim_link_t* found) {
    Link const& of = link_at(__func__, link);
    require_argument(found, __func__, "found");
    World const& world = *context.world;
    static_assert(POGOSIM_ARENA == kNone);
    *found = described(of.kind, pogosim::object_of_body(world, of.a), pogosim::object_of_body(world, of.b), of.end_a_mm,
                       of.end_b_mm);
    found->length_mm = of.length_mm;
    found->stiffness_n_m = of.stiffness_n_m;
    found->damping_n_s_m = of.damping_n_s_m;
    found->breaking_n = of.breaking_n;
    found->least_rad = of.least_rad;
    found->most_rad = of.most_rad;
}

void pogosim_world_link_state(uint32_t link, pogosim_link_state_t* state) {
    Link const& of = link_at(__func__, link);
    require_argument(state, __func__, "state");
    *state = {.length_mm = length(pogosim::places_of_ends(*context.world, of).span_mm()),
              .tension_n = of.tension_n,
              .is_cut = of.is_cut};
}

pogosim_link_t pogosim_world_new_link(pogosim_link_kind_t kind, uint32_t a, uint32_t b) {
    require_world(__func__);
    LinkKind const made = kind_of(__func__, kind);
    NewLink const link = with_links(__func__, [&] { return pogosim::link_between(*context.world, made, a, b); });
    return described(made, a, b, link.end_a_mm, link.end_b_mm);
}

uint32_t pogosim_world_add_link(pogosim_link_t const* link) {
    require_world(__func__);
    require_argument(link, __func__, "link");
    NewLink made{.kind = kind_of(__func__, link->kind), .a = link->a, .b = link->b};
    made.end_a_mm = {number(__func__, "a_x_mm", link->a_x_mm), number(__func__, "a_y_mm", link->a_y_mm)};
    made.end_b_mm = {number(__func__, "b_x_mm", link->b_x_mm), number(__func__, "b_y_mm", link->b_y_mm)};
    if (!std::isnan(link->length_mm)) {
        made.length_mm = number(__func__, "length_mm", link->length_mm);
    }
    made.stiffness_n_m = number(__func__, "stiffness_n_m", link->stiffness_n_m);
    made.damping_n_s_m = number(__func__, "damping_n_s_m", link->damping_n_s_m);
    made.breaking_n = pogosim::narrowed(link->breaking_n);
    made.least_rad = pogosim::narrowed(link->least_rad);
    made.most_rad = pogosim::narrowed(link->most_rad);
    return with_links(__func__, [&] { return pogosim::add_link(*context.world, made); });
}

void pogosim_world_cut_link(uint32_t link) {
    link_at(__func__, link);
    without_exceptions([&] { pogosim::cut_link(*context.world, link); });
}

void pogosim_world_set_column(char const* name, double value) {
    require_world(__func__);
    set_column(__func__, std::nullopt, name, value);
}

void pogosim_world_set_object_column(uint32_t object, char const* name, double value) {
    object_at(__func__, object);
    set_column(__func__, object, name, value);
}
