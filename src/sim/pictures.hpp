// The pictures of a run: frames (save_video_period) and a film (--video). Drawn from copies of the world in other
// threads, so that the run goes on meanwhile; it changes nothing of it.
#pragma once

#include <memory>
#include <string>

#include "config/scenario.hpp"
#include "light/lighting.hpp"
#include "render/frame_lock.hpp"
#include "render/frame_names.hpp"
#include "render/picture_writer.hpp"
#include "sim/due_times.hpp"
#include "sim/snapshot_taker.hpp"
#include "world/world.hpp"

namespace pogosim {

PictureSize picture_size(Scenario const& scenario);

class Pictures {
public:
    /// Null if the run makes no pictures. `film`: empty for none. All references outlive it. Throws ConfigError if
    /// frames or the film cannot be written, and OutOfMemory.
    static std::unique_ptr<Pictures> make(Scenario const& scenario, World const& world, Lighting const& lighting,
                                          SavedColumns const& columns, std::string const& film);

    /// Throws ConfigError for frames that no run could draw. Touches no file.
    static void check_frames(Scenario const& scenario);

    /// Throws ConfigError for a film in extreme slow motion, which would show each step for minutes.
    static void check_film_speed(Scenario const& scenario);

    /// At the start of the run and after each step: hands over the pictures that are due. Throws OutputError, at the
    /// start, if old frames cannot be deleted.
    void record_if_due();

    /// What the pictures show of messages. It outlives this.
    void show_heard(HeardMessages* heard) { taker_.show_heard(heard); }

    /// The run goes on from the present time: pictures until then were taken before, and stay.
    void go_on();

    /// Waits until all pictures are written, and logs an error if some could not be. False then. When a thread that
    /// draws has crashed, nothing waits for it: pictures may be missing.
    bool finish();

private:
    Pictures(Scenario const& scenario, World const& world, Lighting const& lighting, SavedColumns const& columns,
             std::string const& film);

    void delete_old_frames() const;

    Scenario const& scenario_;
    World const& world_;
    FrameNames names_;
    std::unique_ptr<FrameLock> lock_;  // null: no frames, or all are written
    std::string film_;
    SnapshotTaker taker_;
    SnapshotParts parts_;
    Multiples frame_times_;
    Multiples film_times_;
    std::unique_ptr<PictureWriter> writer_;
    bool is_finished_ = false;
    bool all_written_ = true;
};

}  // namespace pogosim
