// Draws a snapshot of a world: the same picture in the window, in frames and in films.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "render/camera.hpp"
#include "render/canvas.hpp"
#include "render/snapshot.hpp"

namespace pogosim {

enum class LinkLayer { hidden, below, above };

struct PaintOptions {
    bool time = true;
    bool scale_bar = true;
    LinkLayer links = LinkLayer::hidden;
    bool lateral_leds = true;
    bool light_levels = false;
    bool trails = false;
    std::optional<std::uint32_t> selected_robot{};  // gets a mark around it
};

/// The parts of a snapshot that a picture with these options needs.
SnapshotParts parts_for(PaintOptions const& options);

/// Keeps what does not change between pictures, such as the floor. Not thread-safe.
class Painter {
public:
    Painter();
    ~Painter();
    Painter(Painter const&) = delete;
    Painter& operator=(Painter const&) = delete;

    /// Draws over the whole canvas.
    void paint(Canvas& canvas, Camera const& camera, Snapshot const& snapshot, PaintOptions const& options);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pogosim
