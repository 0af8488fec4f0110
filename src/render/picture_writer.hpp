// Draws snapshots in other threads and writes the pictures: as frames, one file each, into a film, or both.
//
//   add() ──► queue ──► thread: draws ──► film, in order ──► frame
//                  └──► thread: draws ──► film, in order ──► frame
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/bounded_queue.hpp"
#include "render/camera.hpp"
#include "render/canvas.hpp"
#include "render/film_file.hpp"
#include "render/painter.hpp"
#include "render/snapshot.hpp"

namespace pogosim {

struct PictureFormat {
    PictureSize size;
    ViewOptions paint;
};

/// The files that one snapshot goes into.
struct PictureJob {
    Snapshot snapshot;
    std::filesystem::path frame{};   // empty: no frame
    std::int64_t film_pictures = 0;  // how many of the film show it, one after the other
};

/// Pictures that could not be written, known at the end.
struct PictureErrors {
    std::int64_t frames = 0;  // added
    std::int64_t frames_written = 0;
    std::filesystem::path lost_frame{};  // the first one; empty: none
    std::string frame_error{};           // why
    std::string film_error{};            // empty: none
};

class PictureWriter {
public:
    /// Reserves the memory of the pictures of all threads. `film`: null for frames alone. Throws OutOfMemory; and
    /// OutputError if no thread can be started.
    PictureWriter(PictureFormat const& format, unsigned threads, std::unique_ptr<FilmFile> film);

    /// Calls finish().
    ~PictureWriter();

    PictureWriter(PictureWriter const&) = delete;
    PictureWriter& operator=(PictureWriter const&) = delete;

    /// Hands over a snapshot, and waits if too many are waiting already. The bytes of the frames and of the film do not
    /// depend on the number of threads.
    void add(PictureJob job);

    /// Waits until all pictures are written, and the film is complete.
    PictureErrors const& finish();

private:
    struct Numbered {
        PictureJob job;
        std::int64_t number = 0;
    };

    void start(unsigned threads);
    void work(Canvas& canvas);
    void add_to_film(Numbered const& task, Canvas const& canvas, std::string const& drawing_error);
    void write_frame(Numbered const& task, Canvas const& canvas, std::string drawing_error);

    PictureFormat format_;
    BoundedQueue<Numbered> queue_;
    std::int64_t next_number_ = 0;
    std::vector<Canvas> canvases_;  // by thread

    // State of all threads, protected by the mutex.
    std::mutex mutex_;
    std::condition_variable film_turn_has_come_;
    std::int64_t film_turn_ = 0;  // the number of the next snapshot for the film
    std::unique_ptr<FilmFile> film_;
    PictureErrors errors_;
    std::int64_t lost_number_ = 0;  // of errors_.lost_frame

    std::vector<std::thread> threads_;
    bool is_finished_ = false;
};

}  // namespace pogosim
