#include "render/picture_writer.hpp"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <system_error>
#include <utility>

#include "base/background_thread.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"
#include "render/png_file.hpp"

namespace pogosim {

namespace {

/// Runs `body`. Returns nothing, or what went wrong.
template <class Body>
std::string error_of(Body const& body) {
    try {
        body();
        return "";
    } catch (std::bad_alloc const&) {
        return kOutOfMemory;
    } catch (std::exception const& error) {
        return error.what();
    }
}

std::vector<Canvas> make_canvases(PictureSize size, unsigned count) {
    auto const purpose = [&] {
        return fmt::format("{} picture{} of {} x {} pixels (window_width, window_height)", count, count > 1 ? "s" : "",
                           size.width_px, size.height_px);
    };
    double const bytes =
        static_cast<double>(count) * sizeof(Pixel) * static_cast<double>(size.width_px) * size.height_px;
    return allocate_for(purpose, bytes, [&] { return std::vector<Canvas>(count, Canvas(size)); });
}

}  // namespace

PictureWriter::PictureWriter(PictureFormat const& format, unsigned threads, std::unique_ptr<FilmFile> film)
    : format_(format), queue_(threads), canvases_(make_canvases(format.size, threads)), film_(std::move(film)) {
    start(threads);
}

void PictureWriter::start(unsigned threads) {
    threads_.reserve(threads);
    for (unsigned i = 0; i < threads; ++i) {
        try {
            threads_.push_back(start_background_thread("drawing pictures", [this, i] { work(canvases_[i]); }));
        } catch (std::system_error const& error) {
            if (threads_.empty()) {
                throw OutputError(fmt::format("no thread can be started to draw pictures: {}", error.code().message()));
            }
            return;  // fewer also do
        }
    }
}

PictureWriter::~PictureWriter() {
    finish();
}

void PictureWriter::add(PictureJob job) {
    queue_.push({std::move(job), next_number_++}, has_background_thread_crashed);
}

PictureErrors const& PictureWriter::finish() {
    if (!is_finished_) {
        is_finished_ = true;
        queue_.close();
        for (std::thread& thread : threads_) {
            thread.join();
        }
        if (film_ && errors_.film_error.empty()) {
            errors_.film_error = error_of([this] { film_->finish(); });
        }
        film_.reset();
    }
    return errors_;
}

void PictureWriter::work(Canvas& canvas) {
    std::optional<Painter> painter;
    std::string const error = error_of([&] { painter.emplace(); });
    while (std::optional<Numbered> const task = queue_.pop()) {
        std::string const drawing_error = !painter ? error : error_of([&] {
            Snapshot const& snapshot = task->job.snapshot;
            painter->paint(canvas, camera_for(format_.paint, snapshot, canvas.size()), snapshot, format_.paint);
        });
        add_to_film(*task, canvas, drawing_error);
        write_frame(*task, canvas, drawing_error);
    }
}

/// The oldest snapshot that is not in the film yet is always with a thread, so the others need not wait for long.
void PictureWriter::add_to_film(Numbered const& task, Canvas const& canvas, std::string const& drawing_error) {
    if (!film_) {
        return;
    }
    std::unique_lock lock(mutex_);
    film_turn_has_come_.wait(lock, [&] { return film_turn_ == task.number; });
    if (errors_.film_error.empty()) {
        errors_.film_error = drawing_error;
    }
    if (errors_.film_error.empty()) {
        errors_.film_error = error_of([&] { film_->add(canvas, task.job.film_pictures); });
    }
    ++film_turn_;
    film_turn_has_come_.notify_all();
}

void PictureWriter::write_frame(Numbered const& task, Canvas const& canvas, std::string drawing_error) {
    if (task.job.frame.empty()) {
        return;
    }
    if (drawing_error.empty()) {
        drawing_error = error_of([&] { write_png(task.job.frame, canvas); });
    }
    std::lock_guard const lock(mutex_);
    ++errors_.frames;
    if (drawing_error.empty()) {
        ++errors_.frames_written;
    } else if (errors_.lost_frame.empty() || task.number < lost_number_) {
        errors_.lost_frame = task.job.frame;
        errors_.frame_error = std::move(drawing_error);
        lost_number_ = task.number;
    }
}

}  // namespace pogosim
