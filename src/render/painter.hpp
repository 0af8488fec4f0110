// Draws a snapshot of a world: the same picture in the window, in frames and in films.
#pragma once

#include <memory>

#include "render/camera.hpp"
#include "render/canvas.hpp"
#include "render/snapshot.hpp"
#include "world/view_options.hpp"

namespace pogosim {

/// The parts of a snapshot that a picture with these options needs.
SnapshotParts parts_for(ViewOptions const& options);

/// Where the picture of a snapshot is taken from: the whole arena, or the robot that is followed in the middle.
Camera camera_for(ViewOptions const& options, Snapshot const& snapshot, PictureSize size);

/// Keeps what does not change between pictures, such as the floor. Not thread-safe.
class Painter {
public:
    Painter();
    ~Painter();
    Painter(Painter const&) = delete;
    Painter& operator=(Painter const&) = delete;

    /// Draws over the whole canvas.
    void paint(Canvas& canvas, Camera const& camera, Snapshot const& snapshot, ViewOptions const& options);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pogosim
