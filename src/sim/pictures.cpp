#include "sim/pictures.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/background_thread.hpp"
#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/locked_file.hpp"
#include "base/log.hpp"
#include "config/places.hpp"
#include "render/film_file.hpp"
#include "render/png_file.hpp"
#include "sim/files_of_run.hpp"

namespace pogosim {

namespace {

constexpr double kMostPictureBytes = 1e9;  // of the pictures that are being drawn at the same time

/// One thread is left for the simulation.
unsigned drawing_threads(PictureSize size) {
    double const picture_bytes = static_cast<double>(sizeof(Pixel)) * size.width_px * size.height_px;
    double const fitting = std::max(1.0, kMostPictureBytes / picture_bytes);
    double const usable = std::max(2U, std::thread::hardware_concurrency()) - 1.0;
    return static_cast<unsigned>(std::min(fitting, usable));
}

bool makes_frames(Scenario const& scenario) {
    return scenario.view.save_video_period_s > 0.0;
}

[[noreturn]] void refuse_frames_name(Scenario const& scenario, std::string const& what) {
    throw ConfigError(fmt::format("{}: {}", place_of(scenario, Setting::frames_name), what));
}

/// Frames must not replace each other. Looks at the first ten thousand, which takes 10 ms, and the last two.
void check_names_differ(Scenario const& scenario, FrameNames const& names) {
    constexpr double kLooks = 10000.0;
    double const period_s = scenario.view.save_video_period_s;
    double const step_s = scenario.time_step_s;
    double const count = std::floor(scenario.simulation_time_s / period_s + kWholeTolerance);
    auto const time_s = [&](double multiple) {
        return std::ceil(multiple * period_s / step_s - kWholeTolerance) * step_s;
    };
    for (double multiple = 2.0; multiple <= count; ++multiple) {
        if (multiple > kLooks) {
            multiple = std::max(multiple, count);
        }
        double const before_s = time_s(multiple - 1.0);
        double const now_s = time_s(multiple);
        if (before_s < now_s && names.at(before_s) == names.at(now_s)) {
            refuse_frames_name(
                scenario, fmt::format("the frames of t = {:.6g} s and {:.6g} s would both be '{}'; use more decimals",
                                      before_s, now_s, names.at(now_s).string()));
        }
    }
}

[[noreturn]] void refuse_frame(Scenario const& scenario, std::filesystem::path const& frame,
                               std::string const& reason) {
    refuse_frames_name(scenario, fmt::format("the frame '{}' cannot be written: {}; choose another name or folder",
                                             frame.string(), reason));
}

/// Makes the folder of a frame, and a file in it, which is removed again.
void try_frame(Scenario const& scenario, std::filesystem::path const& frame) {
    std::error_code error;
    if (frame.has_parent_path()) {
        std::filesystem::create_directories(frame.parent_path(), error);
    }
    if (error) {
        refuse_frame(scenario, frame, error.message());
    }
    std::string const beside = unfinished_png(frame).native();
    constexpr mode_t kNewFile = 0666;  // less the umask
    int const descriptor = open(beside.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, kNewFile);
    if (descriptor < 0) {
        refuse_frame(scenario, frame, std::generic_category().message(errno));
    }
    close(descriptor);
    unlink(beside.c_str());
}

/// The first frame and the last one.
std::array<std::filesystem::path, 2> outer_frames(Scenario const& scenario, FrameNames const& names) {
    double const first_s = std::min(scenario.view.save_video_period_s, scenario.simulation_time_s);
    return {names.at(first_s), names.at(scenario.simulation_time_s)};
}

/// Finds problems with the files of frames before the run, as far as possible.
void try_frames(Scenario const& scenario) {
    if (makes_frames(scenario)) {
        for (std::filesystem::path const& frame : outer_frames(scenario, FrameNames(scenario.view.frames_name))) {
            try_frame(scenario, frame);
        }
    }
}

/// Keeps the names of the frames, and their folder, for this run. Null if it draws none.
std::unique_ptr<FrameLock> lock_frames(Scenario const& scenario, FrameNames const& names) {
    if (!makes_frames(scenario)) {
        return nullptr;
    }
    std::string const first = names.at(scenario.view.save_video_period_s).string();
    std::unique_ptr<FrameLock> lock;
    try {
        lock = std::make_unique<FrameLock>(names, scenario.view.delete_old_files);
    } catch (FileError const& error) {
        refuse_frames_name(scenario, fmt::format("the frame '{}' cannot be written: {}; choose another name or folder",
                                                 first, error.what()));
    }
    switch (lock->conflict()) {
        case FrameConflict::none:
            break;
        case FrameConflict::same_names:
            refuse_frames_name(scenario, fmt::format("another run is drawing frames of these names, such as '{}'; wait "
                                                     "for it to finish, or give each run its own names",
                                                     first));
        case FrameConflict::others_draw:
            throw ConfigError(
                fmt::format("{}: another run is drawing frames in the folder '{}', which would be "
                            "deleted; wait for it to finish, or give each run its own folder",
                            place_of(scenario, Setting::delete_old_files), names.folder()->string()));
        case FrameConflict::other_deletes:
            refuse_frames_name(scenario, fmt::format("another run is about to delete all frames in the folder '{}' "
                                                     "(delete_old_files); give each run its own folder",
                                                     names.folder()->string()));
    }
    return lock;
}

PictureFormat picture_format(Scenario const& scenario) {
    return {.size = picture_size(scenario), .paint = scenario.view};
}

std::unique_ptr<PictureWriter> make_writer(PictureFormat const& format, std::string const& film) {
    auto film_file = film.empty() ? nullptr : std::make_unique<FilmFile>(film, format.size);
    return std::make_unique<PictureWriter>(format, drawing_threads(format.size), std::move(film_file));
}

/// Simulated time between two pictures of the film.
double film_period_s(Scenario const& scenario) {
    double const speed_up = scenario.view.gui_speed_up;
    return (speed_up > 0.0 ? speed_up : 1.0) / kFilmHz;
}

}  // namespace

PictureSize picture_size(Scenario const& scenario) {
    return {scenario.view.window_width_px, scenario.view.window_height_px};
}

void Pictures::check_frames(Scenario const& scenario) {
    if (!makes_frames(scenario)) {
        return;
    }
    FrameNames const names(scenario.view.frames_name);
    check_names_differ(scenario, names);
    for (std::filesystem::path const& frame : outer_frames(scenario, names)) {
        if (frame.extension() != ".png") {
            refuse_frames_name(scenario,
                               fmt::format("frames are PNG pictures, and '{}' does not end in .png", frame.string()));
        }
        if (std::string const reason = why_not_writable(frame); !reason.empty()) {
            refuse_frame(scenario, frame, reason);
        }
    }
}

void Pictures::check_film_speed(Scenario const& scenario) {
    constexpr double kMostPicturesPerStep = 1000.0;
    double const least_speed_up = scenario.time_step_s * kFilmHz / kMostPicturesPerStep;
    double const speed_up = scenario.view.gui_speed_up;
    if (speed_up > 0.0 && speed_up < least_speed_up) {
        throw ConfigError(
            fmt::format("{}: at {:g}, the film would show each step of time_step {:g} s for more than {:g} "
                        "pictures; expected at least {:g}, or 0 for real time",
                        place_of(scenario, Setting::speed_up), speed_up, scenario.time_step_s, kMostPicturesPerStep,
                        least_speed_up));
    }
}

std::unique_ptr<Pictures> Pictures::make(Scenario const& scenario, World const& world, Lighting const& lighting,
                                         SavedColumns const& columns, std::string const& film) {
    if (!makes_frames(scenario) && film.empty()) {
        return nullptr;
    }
    check_frames(scenario);
    if (!film.empty()) {
        check_film_speed(scenario);
    }
    try_frames(scenario);
    return std::unique_ptr<Pictures>(new Pictures(scenario, world, lighting, columns, film));
}

Pictures::Pictures(Scenario const& scenario, World const& world, Lighting const& lighting, SavedColumns const& columns,
                   std::string const& film)
    : scenario_(scenario),
      world_(world),
      names_(scenario.view.frames_name),
      lock_(lock_frames(scenario, names_)),
      film_(film),
      taker_(world, lighting, columns),
      parts_(parts_for(scenario.view)),
      frame_times_(scenario.view.save_video_period_s, 1),
      film_times_(film_period_s(scenario), 0),
      writer_(make_writer(picture_format(scenario), film)) {}

void Pictures::record_if_due() {
    if (world_.step == 0 && makes_frames(scenario_) && scenario_.view.delete_old_files) {
        delete_old_frames();
        lock_->share_folder();
    }
    if (parts_.trails) {
        taker_.follow_trails();
    }
    double const time_s = world_.time_s();
    bool const frame_is_due = frame_times_.reached(time_s) > 0;
    std::int64_t const film_pictures = film_.empty() ? 0 : film_times_.reached(time_s);
    if (!frame_is_due && film_pictures == 0) {
        return;
    }
    std::filesystem::path frame;
    if (frame_is_due) {
        frame = names_.at(time_s);
        if (!names_.folder()) {  // a new one for each frame; writing it says what is wrong
            std::error_code ignored;
            std::filesystem::create_directories(frame.parent_path(), ignored);
        }
    }
    writer_->add({.snapshot = taker_.take(parts_), .frame = std::move(frame), .film_pictures = film_pictures});
}

void Pictures::go_on() {
    if (makes_frames(scenario_) && scenario_.view.delete_old_files) {
        lock_->share_folder();
    }
    frame_times_.reached(world_.time_s());
    film_times_.reached(world_.time_s());
}

void Pictures::delete_old_frames() const {
    std::optional<std::filesystem::path> const folder = names_.folder();
    if (!folder) {
        return;
    }
    std::error_code error;
    std::vector<std::filesystem::path> old;  // deleting during the iteration may skip some
    for (auto entry = std::filesystem::directory_iterator(*folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        std::error_code unknown;
        if (entry->path().extension() == ".png" &&
            entry->symlink_status(unknown).type() == std::filesystem::file_type::regular &&
            !is_used_file(scenario_, film_, entry->path())) {
            old.push_back(entry->path());
        }
    }
    for (std::filesystem::path const& path : old) {
        std::filesystem::remove(path, error);
        if (error) {
            throw OutputError(
                fmt::format("delete_old_files: '{}' cannot be deleted: {}", path.string(), error.message()));
        }
    }
    if (!old.empty()) {
        log().info("delete_old_files: deleted {} *.png in '{}'", old.size(), folder->string());
    }
}

bool Pictures::finish() {
    if (is_finished_) {
        return all_written_;
    }
    is_finished_ = true;
    if (has_background_thread_crashed()) {
        [[maybe_unused]] PictureWriter const* const used_by_stopped_threads = writer_.release();
        all_written_ = false;
        return false;
    }
    PictureErrors const& errors = writer_->finish();
    lock_.reset();
    if (!errors.lost_frame.empty()) {
        log().error("the frame '{}' could not be written: {}; {} of {} frames were written",
                    escaped(errors.lost_frame.string()), errors.frame_error, errors.frames_written, errors.frames);
    }
    if (!errors.film_error.empty()) {
        log().error("the film '{}' could not be written: {}", escaped(film_), escaped(errors.film_error));
    }
    all_written_ = errors.lost_frame.empty() && errors.film_error.empty();
    return all_written_;
}

}  // namespace pogosim
