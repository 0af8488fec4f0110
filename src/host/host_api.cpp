// pogosim/host.h. No exception crosses into the host.
#include "pogosim/host.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/floating_point.hpp"
#include "config/scenario.hpp"
#include "device/sensing.hpp"
#include "host/hosted_run.hpp"
#include "host/pixels.hpp"
#include "host/status.hpp"
#include "pogosim/version.h"
#include "render/canvas.hpp"

using namespace pogosim;

namespace {

double number(auto value) {
    return static_cast<double>(value);
}

struct NamedNumber {
    std::string_view name;
    double (*value)(pogosim_run const& run);
};
constexpr std::array kNumbers{
    NamedNumber{"time", [](pogosim_run const& run) { return run.simulation().world().time_s(); }},
    NamedNumber{"step", [](pogosim_run const& run) { return number(run.simulation().world().step); }},
    NamedNumber{"step_count", [](pogosim_run const& run) { return number(run.simulation().step_count()); }},
    NamedNumber{"time_step", [](pogosim_run const& run) { return run.simulation().world().time_step_s; }},
    NamedNumber{"is_over", [](pogosim_run const& run) { return number(run.is_over()); }},
    NamedNumber{"has_failed", [](pogosim_run const& run) { return number(run.has_failed()); }},
    NamedNumber{"save_time", [](pogosim_run const& run) { return run.simulation().saved_columns().time_s(); }},
    NamedNumber{"seed", [](pogosim_run const& run) { return number(run.simulation().seed()); }},
    NamedNumber{"object_count", [](pogosim_run const& run) { return number(run.simulation().world().objects.size()); }},
    NamedNumber{"robot_count", [](pogosim_run const& run) { return number(run.simulation().world().robots.size()); }},
    NamedNumber{"lamp_count", [](pogosim_run const& run) { return number(run.simulation().world().lamps.size()); }},
    NamedNumber{"link_count", [](pogosim_run const& run) { return number(run.simulation().world().links.size()); }},
    NamedNumber{"part_count", [](pogosim_run const& run) { return number(part_count(run.simulation().world())); }},
    NamedNumber{"user_data_bytes",
                [](pogosim_run const& run) { return number(run.simulation().controllers().user_data_bytes()); }},
};

}  // namespace

std::optional<double> pogosim::number_of(pogosim_run const& run, std::string_view name) {
    auto const* const found = std::ranges::find(kNumbers, name, &NamedNumber::name);
    return found == kNumbers.end() ? std::nullopt : std::optional(found->value(run));
}

void pogosim::read_light_levels(World const& world, double* levels) {
    for (std::size_t robot = 0; robot < world.robots.size(); ++robot) {
        std::uint32_t const body = world.robots.body[robot];
        levels[robot] = body == kNone ? -1.0 : mean_light(world, static_cast<std::uint32_t>(robot));
    }
}

char const* pogosim_host_error() {
    return error_text().c_str();
}

char const* pogosim_host_version() {
    return POGOSIM_VERSION_STRING;
}

int pogosim_run_open(pogosim_run_options const* options, pogosim_run** run) {
    *run = nullptr;
    return with_status([&] {
        if (options->seed > std::numeric_limits<std::uint32_t>::max()) {
            throw ConfigError(fmt::format("seed: expected an integer from 0 to {}, found {}",
                                          std::numeric_limits<std::uint32_t>::max(), options->seed));
        }
        if (options->configuration == nullptr) {
            throw ConfigError("configuration: expected the name of a YAML file, found NULL");
        }
        *run = std::make_unique<pogosim_run>(*options).release();
        return POGOSIM_OK;
    });
}

int pogosim_run_step(pogosim_run* run, int64_t steps, double budget_s, int64_t* done) {
    *done = 0;
    return with_status_of(*run, [&] {
        *done = run->step(steps, budget_s);
        return run->is_over() ? POGOSIM_OVER : POGOSIM_OK;
    });
}

void pogosim::take_turn(pogosim_run& run, pogosim_turn& turn, double budget_s) {
    turn.status = with_status([&] {
        if (run.has_failed() || (turn.left > 0 && !run.is_over())) {  // a failed run says so
            turn.left -= run.step(turn.left, budget_s);
        }
        return run.is_over() ? POGOSIM_OVER : POGOSIM_OK;
    });
    turn.has_messages = run.has_messages() ? 1 : 0;
}

int pogosim_run_take_turn(pogosim_run* run, pogosim_turn* turn, double budget_s) {
    std::lock_guard const lock(run->in_use);
    take_turn(*run, *turn, budget_s);
    return turn->status;
}

int pogosim_run_end(pogosim_run* run) {
    return with_status_of(*run, [&] {
        run->end();
        return POGOSIM_OK;
    });
}

void pogosim_run_leave_archive(pogosim_run* run) {
    std::lock_guard const lock(run->in_use);
    run->simulation().leave_archive();
}

void pogosim_run_close(pogosim_run* run) {
    delete run;
}

int pogosim_run_number(pogosim_run const* run, char const* name, double* value) {
    std::lock_guard const lock(run->in_use);
    if (std::optional<double> const found = number_of(*run, name)) {
        *value = *found;
        return POGOSIM_OK;
    }
    return failed(fmt::format("a run has no number '{}'", name));
}

int pogosim_run_array(pogosim_run const* run, char const* name, pogosim_array* array) {
    std::lock_guard const lock(run->in_use);
    if (auto const found = array_of(run->simulation(), name)) {
        *array = *found;
        return POGOSIM_OK;
    }
    return failed(fmt::format("a run has no array '{}'", name));
}

char const* pogosim_run_categories(pogosim_run const* run) {
    return run->categories().c_str();
}

char const* pogosim_run_columns(pogosim_run const* run) {
    return run->columns().c_str();
}

char const* pogosim_run_messages(pogosim_run* run) {
    std::lock_guard const lock(run->in_use);
    return run->take_messages().c_str();
}

int pogosim_run_draw(pogosim_run* run, int32_t width_px, int32_t height_px, uint8_t* rgb) {
    return with_status_of(*run, [&] {
        Canvas const canvas = run->simulation().picture(checked_size(width_px, height_px));
        copy_pixels(canvas, rgb, 3 * static_cast<std::size_t>(width_px));
        return POGOSIM_OK;
    });
}

int pogosim_run_set_pose(pogosim_run* run, size_t robot, double x_mm, double y_mm, double heading_rad) {
    return with_status_of(*run, [&] {
        World const& world = run->simulation().world();
        if (robot >= world.robots.size()) {
            throw ConfigError(fmt::format("there is no robot {}: the run has {}", robot, world.robots.size()));
        }
        auto const object = std::ranges::find(world.objects, static_cast<std::uint32_t>(robot), &Object::robot);
        auto const index = static_cast<std::uint32_t>(object - world.objects.begin());
        Vec2 const place_mm{static_cast<float>(x_mm), static_cast<float>(y_mm)};
        if (!run->simulation().set_pose(index, place_mm, static_cast<float>(heading_rad))) {
            throw ConfigError(fmt::format("robot {} has no body that could be moved", robot));
        }
        return POGOSIM_OK;
    });
}

int pogosim_run_set_parameter(pogosim_run* run, char const* name, char const* value) {
    return with_status_of(*run, [&] {
        if (!run->simulation().set_parameter(name, value)) {
            throw ConfigError(fmt::format(
                "parameters.{}: the program has not read it into a global variable or USERDATA, so it can only be set "
                "for a new run",
                name));
        }
        return POGOSIM_OK;
    });
}

void pogosim_run_light_levels(pogosim_run const* run, double* levels) {
    StandardFloatingPoint const mode;
    std::lock_guard const lock(run->in_use);
    read_light_levels(run->simulation().world(), levels);
}

uint64_t pogosim_run_hash(pogosim_run const* run) {
    std::lock_guard const lock(run->in_use);
    return run->simulation().hash();
}

int pogosim_run_save(pogosim_run* run) {
    return with_status_of(*run, [&] {
        run->simulation().save_now();
        return POGOSIM_OK;
    });
}
