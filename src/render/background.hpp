// The lowest layer: paper, floor, light, walls. It is redrawn only when it changes.
#pragma once

#include <memory>
#include <vector>

#include "render/camera.hpp"
#include "render/canvas.hpp"
#include "render/snapshot.hpp"
#include "render/theme_colours.hpp"

namespace pogosim {

class Background {
public:
    /// Fills the whole canvas.
    void draw(Canvas& canvas, Camera const& camera, Snapshot const& snapshot, ThemeColours const& colours,
              bool light_levels);

    /// The place of the floor in the picture drawn last.
    Coverage const& floor() const { return floor_; }

private:
    bool is_as_before(Canvas const& canvas, Camera const& camera, Snapshot const& snapshot,
                      ThemeColours const& colours) const;
    void draw_floor(Canvas const& canvas, Camera const& camera, Scenery const& scenery, ThemeColours const& colours);
    void draw_light(Camera const& camera, Scenery const& scenery, LightMap const& light, Pixel lamplight);
    void draw_programmed_walls(Camera const& camera, Snapshot const& snapshot);
    std::vector<Pixel> wall_colours(Snapshot const& snapshot, ThemeColours const& colours) const;

    // The state that the picture shows.
    std::shared_ptr<Scenery const> scenery_;
    Camera camera_;
    ThemeColours colours_;
    std::shared_ptr<LightMap const> light_;
    std::vector<Pixel> wall_colours_;  // by outline of the scenery

    Canvas empty_{{0, 0}};    // paper, floor and walls
    Canvas picture_{{0, 0}};  // with light, and the colours of walls with a program
    Coverage floor_;
    Coverage scratch_;

    // Cells of the light map whose centres are in the arena.
    std::vector<bool> inside_;
    std::vector<float> opacity_;  // of cells
};

}  // namespace pogosim
