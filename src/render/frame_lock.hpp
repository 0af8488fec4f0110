// Locks that say which run may draw frames of certain names, and which may delete frames of a folder.
//
//     a file beside the frame of t = 0     locked: one run draws frames of these names
//     the folder of the frames             locked by all runs that draw into it: none deletes the frames of another;
//                                          locked by one alone while it deletes old frames
#pragma once

#include <sys/types.h>

#include "base/locked_file.hpp"
#include "render/frame_names.hpp"

namespace pogosim {

/// The reason why a run must not draw.
enum class FrameConflict {
    none,
    same_names,    // another run draws frames of these names
    others_draw,   // old frames are to be deleted, and another run draws into the folder
    other_deletes  // another run deletes the frames of the folder
};

class FrameLock {
public:
    /// `deletes`: the run will delete the old frames. Throws FileError if the lock cannot be made. It belongs to the
    /// process that made it.
    FrameLock(FrameNames const& names, bool deletes);
    ~FrameLock();

    FrameLock(FrameLock const&) = delete;
    FrameLock& operator=(FrameLock const&) = delete;

    FrameConflict conflict() const { return conflict_; }

    /// Old frames have been deleted: other runs may draw into the folder.
    void share_folder() const;

private:
    FrameConflict conflict_ = FrameConflict::none;
    LockedFile names_;
    int folder_ = -1;  // none: it depends on the time
    pid_t owner_;
};

}  // namespace pogosim
