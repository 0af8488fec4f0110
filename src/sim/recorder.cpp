#include "sim/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "config/configuration_text.hpp"
#include "config/scenario.hpp"
#include "geometry/arena.hpp"
#include "physics/physics_engine.hpp"
#include "pogosim/version.h"
#include "process/crash_handler.hpp"
#include "process/crash_message.hpp"
#include "sim/files_of_run.hpp"
#include "sim/object_facts.hpp"
#include "sim/robot_values.hpp"
#include "version/commit.hpp"
#include "world/link_places.hpp"

namespace pogosim {

namespace {

// Metadata that a data file stores about its run.

constexpr float kFitMargin = 0.95F;  // of the window that the arena fills

/// Scale at which the arena fills the window, within what the window can zoom.
float fitted_mm_to_pixels(ViewConfig const& view, Arena const& arena) {
    Vec2 const size = arena.bounds.size();
    float const fit =
        std::min(static_cast<float>(view.window_width_px) / size.x, static_cast<float>(view.window_height_px) / size.y);
    return std::clamp(kFitMargin * fit, 0.1F, 10.0F);
}

std::string polygons_as_yaml(Arena const& arena) {
    std::string text;
    for (Polygon const& polygon : arena.polygons) {
        std::string separator = "- [";
        for (Vec2 const corner : polygon) {
            text += fmt::format("{}{{x: {}, y: {}}}", separator, corner.x, corner.y);
            separator = ", ";
        }
        text += "]\n";
    }
    return text;
}

/// Schema metadata: program_version, program_commit, configuration and resolved_configuration (see ConfigurationText),
/// objects (see object_facts()), and arena_polygons (YAML list of lists of {x, y}, mm). `run.mm_to_pixels` is found
/// here.
std::vector<std::pair<std::string, std::string>> run_metadata(Scenario const& scenario, World const& world,
                                                              RunValues run) {
    run.mm_to_pixels = fitted_mm_to_pixels(scenario.view, world.arena);
    ConfigurationText const text = configuration_text(scenario, run);
    return {{"program_version", POGOSIM_VERSION_STRING},
            {"program_commit", commit()},
            {"configuration", text.written},
            {"resolved_configuration", text.resolved},
            {"objects", object_facts(scenario, world)},
            {"arena_polygons", polygons_as_yaml(world.arena)}};
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

/// A rigid body has a place and a heading, a membrane the place of its first body, a wall its centre and heading 0.
/// Fills a fresh row in its place: to copy one that has just been written takes longer than to write it.
void fill_row(ObjectRow& row, World const& world, Object const& object, std::span<float const> tension_n) {
    row.category = world.categories[object.category].name;
    row.id = static_cast<std::int32_t>(object.id);
    row.x_mm = row.y_mm = row.angle_rad = kNoValue;
    row.led_rgb = object.robot != kNone ? packed_rgb(world.robots.led[object.robot][0]) : 0;
    row.tension_n = object.body != kNone ? tension_n[object.body] : 0.0F;
    if (object.body == kNone) {
        row.x_mm = object.fixed_mm.x;
        row.y_mm = object.fixed_mm.y;
        row.angle_rad = 0.0F;
    } else {
        Vec2 const place_mm = wrapped(world, world.bodies.position_mm[object.body]);
        row.x_mm = place_mm.x;
        row.y_mm = place_mm.y;
    }
    if (object.body_count == 1) {
        row.angle_rad = wrap_angle(world.bodies.heading_rad[object.body]);
    }
}

/// Its rows are followed by those of its subparts.
bool has_subparts(Category const& category) {
    auto const& membrane = category.spec.membrane;
    return membrane && membrane->in_data_file;
}

}  // namespace

Recorder::Recorder(Scenario const& scenario, World const& world, Controllers& controllers, Brains const& brains,
                   DataExport& data, std::uint32_t seed)
    : scenario_(scenario),
      world_(world),
      controllers_(controllers),
      brains_(brains),
      export_(data),
      seed_(seed),
      category_is_recorded_(recorded_categories(scenario, world)),
      row_times_(output().row_timing, output().save_data_period_s) {
    if (output().enable_data_logging) {
        check_table_format(scenario, Setting::data_filename, output().data_filename);
        reserved_ = DataFile::reserve(output().data_filename);
    }
    if (!output().message_log.empty()) {
        check_table_format(scenario, Setting::message_log, output().message_log);
        messages_ = std::make_unique<MessageRecorder>(output().message_log, world);
    }
}

std::optional<UserFailure> Recorder::open() {
    open_message_log();
    if (!output().enable_data_logging) {
        check_shown_values(scenario_, world_, {});
        return std::nullopt;
    }
    if (auto failure = call_user_code([this] { controllers_.declare_columns(); })) {
        return failure;
    }
    for (auto const& brain : brains_) {
        brain->declare_columns(export_.columns);
    }
    check_shown_values(scenario_, world_, export_.columns);
    export_.was_set.resize(export_.columns.size(), true);
    make_data_file();
    is_opened_ = true;
    show(shown_);
    if (kept_ != nullptr) {
        kept_->open(export_.columns, world_.robots.size());
    }
    return std::nullopt;
}

void Recorder::show(RecordedRows* rows) {
    shown_ = rows;
    if (rows != nullptr && is_opened_) {
        rows->open(export_.columns, output().fields);
    }
}

void Recorder::open_without_rows() {
    if (!data_file_ && output().enable_data_logging) {
        make_data_file();
    }
    open_message_log();
}

void Recorder::open_message_log() {
    if (messages_ && !messages_->is_open()) {
        messages_->open({.path = output().message_log, .metadata = metadata()});
    }
}

std::vector<std::pair<std::string, std::string>> Recorder::metadata() const {
    return run_metadata(scenario_, world_,
                        {.seed = seed_,
                         .time_step_s = world_.time_step_s,
                         .is_periodic = world_.periodic,
                         .physics_engine = physics_engine_behind(scenario_.physics_engine)});
}

void Recorder::make_data_file() {
    DataFileOptions options;
    options.path = output().data_filename;
    options.user_columns = export_.columns;
    options.fields = output().fields;
    options.subpart_column = std::ranges::any_of(world_.categories, has_subparts);
    options.led_column = output().led_column;
    options.tension_column = !world_.links.empty() || !world_.link_categories.empty();
    options.flush_row_count = output().flush_row_count;
    options.metadata = metadata();
    if (std::string links = LinkRecord::initial(world_); !links.empty()) {
        options.metadata.emplace_back("links", std::move(links));
    }
    if (rows_before_) {
        options.metadata.emplace_back("continued_after_rows", fmt::format("{}", *rows_before_));
    }
    data_file_ = std::make_unique<DataFile>(options, std::move(reserved_));
    note_data_file(options.path, DataFileState::open);
    empty_cells_.assign(options.user_columns.size(), CellValue());
}

std::optional<UserFailure> Recorder::record_if_due() {
    if (messages_) {
        messages_->record();
    }
    if (!data_file_) {
        return std::nullopt;
    }
    links_.follow(world_);
    std::optional<double> const due_s = row_times_.due(world_);
    row_time_s_ = due_s.value_or(row_time_s_);
    return due_s ? record_rows() : std::nullopt;
}

std::optional<UserFailure> Recorder::record_rows() {
    std::optional<UserFailure> failure = fill_table();
    if (kept_ != nullptr) {
        kept_->save(world_, table_);
    }
    write_table();
    if (shown_ != nullptr && !failure) {
        show_table();
    }
    return failure;
}

std::optional<UserFailure> Recorder::fill_table() {
    table_.clear();
    table_.object.reserve(world_.objects.size());
    table_.cells.reserve(world_.objects.size() * export_.columns.size());
    std::optional<UserFailure> failure = call_user_code([this] {
        for (std::uint32_t i = 0; i < world_.objects.size(); ++i) {
            if (category_is_recorded_[world_.objects[i].category]) {
                add_to_table(i);
            }
        }
    });
    table_.cells.resize(table_.object.size() * export_.columns.size());  // without those of a row that failed
    return failure;
}

void Recorder::add_to_table(std::uint32_t object) {
    std::uint32_t const robot = world_.objects[object].robot;
    std::size_t const first_cell = table_.cells.size();
    table_.cells.resize(first_cell + export_.columns.size());
    std::span const cells = std::span(table_.cells).subspan(first_cell);
    if (robot == kNone) {
        export_.held.fill(object, cells);
    } else if (!controllers_.export_row(robot, object, cells)) {
        table_.cells.resize(first_cell);
        return;
    }
    for (auto const& brain : brains_) {
        brain->fill_row(robot, cells);
    }
    table_.object.push_back(object);
}

/// Rows that follow each other are written together.
void Recorder::write_table() {
    std::size_t const count = table_.object.size();
    std::vector<float> const tension_n = tensions_of_bodies(world_);
    built_in_.clear();
    std::size_t first = 0;
    auto const write_until = [&](std::size_t end) {
        data_file_->append(std::span(built_in_).subspan(first, end - first), table_.cells_of(first, end));
        first = end;
    };
    for (std::size_t row = 0; row < count; ++row) {
        Object const& object = world_.objects[table_.object[row]];
        ObjectRow& built_in = built_in_.emplace_back();
        built_in.time_s = row_time_s_;
        built_in.ticks = ticks_of(object);
        fill_row(built_in, world_, object, tension_n);
        if (has_subparts(world_.categories[object.category])) {
            write_until(row + 1);
            record_subparts(object, built_in);
        }
    }
    write_until(count);
}

/// Null for objects without a program.
std::optional<std::int64_t> Recorder::ticks_of(Object const& object) const {
    return object.robot != kNone ? std::optional<std::int64_t>(controllers_.ticks(object.robot)) : std::nullopt;
}

void Recorder::show_table() {
    shown_->begin(row_time_s_);
    for (std::size_t row = 0; row < table_.object.size(); ++row) {
        Object const& object = world_.objects[table_.object[row]];
        if (object.robot != kNone) {
            shown_->add(object.robot, built_in_[row], table_.cells_of(row));
        }
    }
    shown_->end();
}

void Recorder::record_subparts(Object const& object, ObjectRow row) {
    for (std::uint32_t part = 0; part < object.body_count; ++part) {
        Vec2 const position_mm = wrapped(world_, world_.bodies.position_mm[object.body + part]);
        row.x_mm = position_mm.x;
        row.y_mm = position_mm.y;
        row.subpart = static_cast<std::int16_t>(part);
        data_file_->append(row, empty_cells_);
    }
}

void Recorder::save_if_due() {
    if (data_file_) {
        data_file_->save_if_due();
    }
    if (messages_ && messages_->is_open()) {
        messages_->save_if_due();
    }
}

void Recorder::save_now() {
    if (data_file_) {
        data_file_->save();
    }
    if (messages_ && messages_->is_open()) {
        messages_->save();
    }
}

void Recorder::add_metadata(std::string const& key, std::string const& value) {
    if (data_file_) {
        data_file_->add_metadata(key, value);
    }
    if (messages_ && messages_->is_open()) {
        messages_->add_metadata(key, value);
    }
}

void Recorder::close() {
    if (data_file_) {
        if (std::string const changes = links_.changes(world_); !changes.empty()) {
            data_file_->add_metadata("link_changes", changes);
        }
        data_file_->close();
        is_complete_ = true;
        note_data_file(output().data_filename, DataFileState::complete);
    }
    if (messages_ && messages_->is_open()) {
        messages_->close();
    }
}

void Recorder::append_state(StateWriter& state) const {
    state(links_, messages_ ? messages_->count() : std::int64_t{0});
    row_times_.append_state(state);
}

void Recorder::take_state(StateReader& state) {
    std::int64_t messages = 0;
    state(links_, messages);
    row_times_.take_state(state, world_);
    if (messages_) {
        messages_->go_on_from(messages);
    }
}

std::optional<std::int64_t> Recorder::row_count() const {
    return data_file_ ? std::optional(data_file_->row_count()) : std::nullopt;
}

std::string Recorder::note() const {
    bool const has_messages = messages_ && messages_->is_complete();
    if (is_opened_ && is_complete_) {
        return fmt::format(". The data file '{}' contains all rows up to that point", output().data_filename) +
               (has_messages ? fmt::format(", the message log '{}' all messages", output().message_log) : "");
    }
    return has_messages
               ? fmt::format(". The message log '{}' contains all messages up to that point", output().message_log)
               : "";
}

}  // namespace pogosim
