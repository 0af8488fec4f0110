#include "sim/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/log.hpp"
#include "pogosim/version.h"
#include "sim/build_world.hpp"
#include "sim/interrupt.hpp"
#include "sim/lamps_of.hpp"
#include "sim/progress_bar.hpp"
#include "sim/run_metadata.hpp"

namespace pogosim {

namespace {

// A time that should be a whole number of periods or steps may differ from it in the last bits.
constexpr double kWholeTolerance = 1e-6;

std::uint32_t seed_of(Scenario const& scenario) {
    return scenario.seed ? *scenario.seed : static_cast<std::uint32_t>(std::random_device{}());
}

std::vector<bool> recorded_categories(Scenario const& scenario, World const& world) {
    std::vector<bool> recorded;
    for (Category const& category : world.categories) {
        auto const& allowed = scenario.output.categories;
        recorded.push_back(!allowed || std::find(allowed->begin(), allowed->end(), category.name) != allowed->end());
    }
    return recorded;
}

std::int32_t packed_rgb(Rgb color) {
    return color.r << 16 | color.g << 8 | color.b;
}

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

/// A rigid body has a place and a heading, a ring the place of its first body, a wall neither.
ObjectRow row_of(World const& world, Object const& object, std::optional<std::int64_t> ticks) {
    ObjectRow row{.time_s = static_cast<float>(world.time_s()),
                  .category = world.categories[object.category].name,
                  .id = object.id,
                  .ticks = ticks,
                  .x_mm = kNoValue,
                  .y_mm = kNoValue,
                  .angle_rad = kNoValue,
                  .led_rgb = object.robot != kNone ? packed_rgb(world.robots.led[object.robot][0]) : 0};
    if (object.body != kNone) {
        Vec2 const place_mm = wrapped(world, world.bodies.position_mm[object.body]);
        row.x_mm = place_mm.x;
        row.y_mm = place_mm.y;
    }
    if (object.body_count == 1) {
        row.angle_rad = wrap_angle(world.bodies.heading_rad[object.body]);
    }
    return row;
}

bool has_subparts(World const& world) {
    return std::ranges::any_of(world.categories, [](Category const& category) {
        return category.spec.ring && category.spec.ring->in_data_file;
    });
}

}  // namespace

Simulation::Simulation(Scenario scenario, RunOptions options)
    : scenario_(std::move(scenario)),
      options_(options),
      seed_(seed_of(scenario_)),
      world_(build_world(scenario_, seed_)),
      parameters_(scenario_.parameters),
      services_{.parameters = &parameters_, .seed = seed_, .data = {}, .stop_requested = false, .warned = {}},
      programs_(world_, services_, seed_),
      lighting_(lamps_of(scenario_, world_.arena), world_),
      physics_(make_box2d_engine(world_, {.friction = static_cast<float>(scenario_.wall_friction),
                                          .restitution = static_cast<float>(scenario_.wall_restitution)})),
      category_is_recorded_(recorded_categories(scenario_, world_)),
      stages_(options.measure_stages) {}

Simulation::~Simulation() = default;

std::int64_t Simulation::step_count() const {
    return static_cast<std::int64_t>(std::ceil(scenario_.simulation_time_s / world_.time_step_s - kWholeTolerance));
}

bool Simulation::is_over() const {
    return world_.step >= step_count() || services_.stop_requested || interrupted();
}

ExitCode Simulation::run() {
    std::optional<UserFailure> failure;
    std::optional<UserFailure> const crash = call_simulator_code([&] { failure = run_steps(); });
    if (crash) {
        failure = crash;
    }
    // The message first: completing the file may fail after a crash that destroyed memory.
    if (failure) {
        report(*failure);
        if (!failure->refused && !data_file_ && scenario_.output.enable_data_logging) {
            make_data_file();  // without rows: the file of an earlier run must not pass for this one's
        }
        finish();
        call_user_code([this] { programs_.print_unfinished_lines(); });
        return failure->code;
    }
    finish();
    if (interrupted()) {
        log().warn("interrupted at t = {:.4f} s{}", world_.time_s(), data_file_note());
        return ExitCode::interrupted;
    }
    return ExitCode::done;
}

std::optional<UserFailure> Simulation::run_steps() {
    std::optional<UserFailure> failure = start();
    ProgressBar progress(step_count(), world_.time_step_s, options_.progress_bar);
    while (!failure && !is_over()) {
        failure = step();
        progress.show(world_.step);
    }
    progress.finish(world_.step);
    if (!failure) {
        failure = call_user_code([this] {
            programs_.end();
            programs_.print_unfinished_lines();
        });
    }
    return failure;
}

std::optional<UserFailure> Simulation::start() {
    log().debug("seed {}, {} robots with {} bytes of user data each, {} steps of {} s", seed_, world_.robots.size(),
                Programs::user_data_bytes(), step_count(), world_.time_step_s);
    install_user_guard(scenario_.user_code_timeout_s);
    lighting_.update(world_);
    if (auto failure = call_user_code([this] { programs_.start(); })) {
        return failure;
    }
    fit_time_step();
    if (auto failure = open_data_file()) {
        return failure;
    }
    return record_if_due();
}

std::optional<UserFailure> Simulation::step() {
    stages_.begin_step();
    lighting_.update(world_);
    stages_.end(Stage::light);
    if (auto failure = call_user_code([this] { programs_.run_step(); })) {
        return failure;
    }
    stages_.end(Stage::robots);
    channel_.deliver(world_);
    stages_.end(Stage::messages);
    physics_->advance(world_);
    stages_.end(Stage::physics);
    ++world_.step;
    auto failure = record_if_due();
    stages_.end(Stage::record);
    return failure;
}

void Simulation::finish() {
    if (data_file_) {
        data_file_->close();
    }
    report_losses();
}

void Simulation::fit_time_step() {
    int const hz = programs_.highest_loop_hz();
    if (hz == 0) {
        return;
    }
    // Robots sleep whole milliseconds between ticks, and tick once a step at most.
    double const tick_s = std::floor(1000.0 / hz) / 1000.0;
    if (world_.time_step_s > tick_s) {
        log().warn("time_step is lowered from {} s to {} s, so that a robot with main_loop_hz {} gets all its ticks",
                   world_.time_step_s, tick_s, hz);
        world_.time_step_s = tick_s;
    }
}

std::optional<UserFailure> Simulation::open_data_file() {
    if (!scenario_.output.enable_data_logging) {
        return std::nullopt;
    }
    if (auto failure = call_user_code([this] { programs_.declare_columns(); })) {
        return failure;
    }
    make_data_file();
    return std::nullopt;
}

void Simulation::make_data_file() {
    OutputConfig const& output = scenario_.output;
    DataFileOptions options;
    options.path = output.data_filename;
    options.user_columns = services_.data.columns;
    options.fields = output.fields;
    options.subpart_column = has_subparts(world_);
    options.led_column = output.led_column;
    options.flush_row_count = output.flush_row_count;
    options.metadata = run_metadata(scenario_, world_.arena, seed_);
    data_file_ = std::make_unique<DataFile>(options);
    empty_row_.values.assign(options.user_columns.size(), CellValue());
}

std::optional<UserFailure> Simulation::record_if_due() {
    double const period_s = scenario_.output.save_data_period_s;
    bool const at_start = world_.step == 0;
    if (!data_file_ || (period_s <= 0.0 && !at_start)) {
        return std::nullopt;
    }
    // Rows belong to the first step at or after each multiple of the period.
    double const periods = at_start ? 0.0 : world_.time_s() / period_s + kWholeTolerance;
    if (periods < static_cast<double>(next_row_time_)) {
        return std::nullopt;
    }
    next_row_time_ = static_cast<std::int64_t>(periods) + 1;
    return record_rows();
}

std::optional<UserFailure> Simulation::record_rows() {
    DataRow const& row = services_.data.row;
    for (Object const& object : world_.objects) {
        if (!category_is_recorded_[object.category]) {
            continue;
        }
        if (object.robot == kNone) {
            data_file_->append(row_of(world_, object, std::nullopt), empty_row_.values);
            continue;
        }
        if (auto failure = call_user_code([this, &object] { programs_.export_row(object.robot); })) {
            return failure;
        }
        if (row.exported) {
            data_file_->append(row_of(world_, object, programs_.ticks(object.robot)), row.values);
            record_subparts(object);
        }
    }
    return std::nullopt;
}

void Simulation::record_subparts(Object const& object) {
    ObjectSpec const& spec = world_.categories[object.category].spec;
    if (!spec.ring || !spec.ring->in_data_file) {
        return;
    }
    ObjectRow row = row_of(world_, object, programs_.ticks(object.robot));
    for (std::uint32_t part = 0; part < object.body_count; ++part) {
        Vec2 const position_mm = wrapped(world_, world_.bodies.position_mm[object.body + part]);
        row.x_mm = position_mm.x;
        row.y_mm = position_mm.y;
        row.subpart = static_cast<std::int16_t>(part);
        data_file_->append(row, empty_row_.values);
    }
}

void Simulation::report(UserFailure const& failure) const {
    std::string const where =
        fmt::format("{} of {}, t = {:.4f} s", context.phase, current_robot_name(), world_.time_s());
    if (failure.refused) {
        log().error("{} (asked for in {}){}", failure.what, where, data_file_note());
        return;
    }
    bool const failed = failure.code != ExitCode::done;  // else it called exit(0)
    log().log(failed ? spdlog::level::err : spdlog::level::warn, "the user program {} in {}: {}{}",
              failed ? "failed" : "ended", where, failure.what, data_file_note());
}

std::string Simulation::data_file_note() const {
    return data_file_ ? fmt::format(". The data file '{}' is complete up to there", scenario_.output.data_filename)
                      : "";
}

void Simulation::report_losses() const {
    std::uint64_t dropped = 0;
    for (std::size_t i = 0; i < world_.robots.size(); ++i) {
        dropped += world_.mailboxes.dropped(i);
    }
    if (dropped > 0) {
        log().info("{} messages were lost because a robot's queue was full (message_queue_size)", dropped);
    }
}

}  // namespace pogosim
