// What the layers of a picture share: a snapshot, and where and how large it is drawn.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/camera.hpp"
#include "render/canvas.hpp"
#include "render/snapshot.hpp"
#include "render/theme_colours.hpp"

namespace pogosim {

constexpr Pixel opaque(Rgb colour) {
    return 0xFF000000U | static_cast<Pixel>(colour.r << 16U | colour.g << 8U | colour.b);
}

/// The colour that a picture has for that of a head LED, now or earlier; `dark`: of one that is off.
inline Pixel shown_colour(Snapshot const& snapshot, ThemeColours const& colours, Rgb led, Pixel dark) {
    return snapshot.shown_rgb.empty() ? colours.of_led(led, dark) : opaque(led);
}

struct Scene {
    Canvas& canvas;
    Camera const& camera;
    Snapshot const& snapshot;
    Coverage const& floor;
    ThemeColours const& colours;

    Scenery const& scenery() const { return *snapshot.scenery; }
    Vec2 to_pixels(Vec2 point_mm) const { return camera.to_pixels(point_mm, canvas.size()); }
    float to_pixels(float length_mm) const { return length_mm * camera.scale_px_mm; }

    /// The unit of the widths of lines and the sizes of marks, pixels: a printer's point where the picture is 8 inches
    /// wide, as those of swarm_picture are.
    float point_px() const {
        auto const least = static_cast<float>(std::min(canvas.size().width_px, canvas.size().height_px));
        return std::clamp(least / 583.0F, 0.5F, 8.0F);
    }

    /// Calls draw(where, mm) for each place at which something that spans `box_mm` around `position_mm` shows: in a
    /// periodic arena also beyond the seams that it crosses.
    template <class Draw>
    void for_each_image(Vec2 position_mm, Box const& box_mm, Draw const& draw) const {
        draw(position_mm);
        if (!scenery().periodic) {
            return;
        }
        Box const& bounds = scenery().arena.bounds;
        Vec2 const low = position_mm + box_mm.min;
        Vec2 const high = position_mm + box_mm.max;
        bool const is_inside =
            low.x >= bounds.min.x && low.y >= bounds.min.y && high.x <= bounds.max.x && high.y <= bounds.max.y;
        if (is_inside) {
            return;
        }
        for (int i = -1; i <= 1; ++i) {
            for (int k = -1; k <= 1; ++k) {
                Vec2 const offset{static_cast<float>(i) * bounds.size().x, static_cast<float>(k) * bounds.size().y};
                Vec2 const a = low + offset;
                Vec2 const b = high + offset;
                bool const shows = a.x < bounds.max.x && b.x > bounds.min.x && a.y < bounds.max.y && b.y > bounds.min.y;
                if (shows && (i != 0 || k != 0)) {
                    draw(position_mm + offset);
                }
            }
        }
    }

    template <class Draw>
    void for_each_image(Vec2 position_mm, float radius_mm, Draw const& draw) const {
        for_each_image(position_mm, Box{{-radius_mm, -radius_mm}, {radius_mm, radius_mm}}, draw);
    }

    /// From one point to another; in a periodic arena the shortest way, across the seam.
    Vec2 from_to(Vec2 from_mm, Vec2 to_mm) const { return minimum_image(scenery(), from_mm, to_mm); }

    /// Corners in pixels.
    Polygon to_pixels(Polygon const& polygon_mm) const {
        Polygon corners(polygon_mm.size());
        std::transform(polygon_mm.begin(), polygon_mm.end(), corners.begin(),
                       [this](Vec2 corner) { return to_pixels(corner); });
        return corners;
    }
};

/// Adds a closed polygon to what is covered, as a line of a width.
inline void add_outline(Coverage& coverage, Polygon const& corners, float width) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
        coverage.add_line(corners[i], corners[i + 1 == corners.size() ? 0 : i + 1], width);
    }
}

}  // namespace pogosim
