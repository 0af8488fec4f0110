// A picture in memory, and the anti-aliased shapes that can be drawn into it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec2.hpp"
#include "render/camera.hpp"

namespace pogosim {

/// 0xAARRGGBB. As a colour to draw with, alpha is the opacity.
using Pixel = std::uint32_t;

/// The same colour with another opacity, 0 to 1.
constexpr Pixel with_opacity(Pixel colour, float opacity) {
    return (colour & 0x00FFFFFFU) | static_cast<Pixel>(opacity * 255.0F + 0.5F) << 24U;
}

/// Pixels from `left`, `top` to below `right`, `bottom`.
struct PixelBox {
    int left = 0;
    int top = 0;
    int right = 0;
    int bottom = 0;

    constexpr int width() const { return right > left ? right - left : 0; }
    constexpr int height() const { return bottom > top ? bottom - top : 0; }
    friend bool operator==(PixelBox const&, PixelBox const&) = default;
};

PixelBox intersection(PixelBox const& a, PixelBox const& b);

/// The pixels that a box in a picture touches; coordinates that are no numbers, or huge, touch what they can.
PixelBox pixels_of(Box const& box_px, PixelBox const& within);

enum class Cap { butt, round };

class Coverage;

/// Points are in pixels, (0, 0) being the top left corner of the picture: pixel (0, 0) covers the square from there to
/// (1, 1). Shapes cover pixels in part, wherever between pixels they lie. What is not finite, or farther than 1e9
/// pixels away, is not drawn. A canvas is opaque, unless it is a layer to be laid over another: then its colours are
/// premultiplied by alpha.
class Canvas {
public:
    explicit Canvas(PictureSize size);

    PictureSize size() const { return size_; }
    PixelBox bounds() const { return {0, 0, size_.width_px, size_.height_px}; }
    void resize(PictureSize size);  // black, and not clipped

    std::span<Pixel> pixels() { return pixels_; }
    std::span<Pixel const> pixels() const { return pixels_; }  // row by row from the top left

    /// Nothing is drawn outside of it from now on.
    void clip_to(PixelBox const& box) { clip_ = intersection(box, bounds()); }
    PixelBox const& clip() const { return clip_; }

    void fill(Pixel colour);

    /// Transparent everywhere.
    void clear();

    /// Draws a layer of the same size.
    void lay_over(Canvas const& layer);
    void disk(Vec2 centre, float radius, Pixel colour);

    /// The half of a disk on the side of `facing`, a unit vector.
    void half_disk(Vec2 centre, float radius, Vec2 facing, Pixel colour);

    /// A circle drawn with a pen of some width, half of it on either side.
    void ring(Vec2 centre, float radius, float width, Pixel colour);

    void line(Vec2 from, Vec2 to, float width, Cap cap, Pixel colour);

    /// A piece of a chain of thin lines: made for speed, with ends that neither overlap nor leave a gap.
    void chain_link(Vec2 from, Vec2 to, float width, Pixel colour);

    /// A closed polygon.
    void polygon(std::span<Vec2 const> corners, Pixel colour);

    /// Light around a point that fades to nothing at the radius: opacity (1 - (d / radius)^2)^2 of the colour's own.
    /// Only where `within` covers the picture.
    void glow(Vec2 centre, float radius, Pixel colour, Coverage const& within);

    /// The covered pixels.
    void cover(Coverage const& coverage, Pixel colour);

    /// One character of a text, or another small picture of opacities, 0 to 255, row by row, at a whole pixel.
    void stamp(std::uint8_t const* opacity, int width, int height, int stride, int left, int top, Pixel colour);

private:
    Pixel* row(int y) {
        return pixels_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width_px);
    }

    PictureSize size_;
    PixelBox clip_;
    std::vector<Pixel> pixels_;
    std::vector<float> area_;  // scratch of polygon()
};

/// How much of each pixel of a box is covered, 0 to 255.
class Coverage {
public:
    /// Nothing is covered.
    void reset(PixelBox const& box);

    PixelBox const& box() const { return box_; }
    std::uint8_t const* row(int y) const { return covered_.data() + offset(y); }  // from the left of the box

    /// What the closed polygons enclose: those that run clockwise on the screen add to it, others cut holes.
    void add_polygons(std::span<std::vector<Vec2> const> polygons);

    /// A line with round ends; where lines overlap, the pixel is covered as by the one that covers most.
    void add_line(Vec2 from, Vec2 to, float width);

    /// The pixels within half the width of a line, less and less with the distance: (1 - d / half)^2.
    void add_glow(Vec2 from, Vec2 to, float width);

    /// Leaves only what another covers, too.
    void keep_within(Coverage const& other);

private:
    std::size_t offset(int y) const {
        return static_cast<std::size_t>(y - box_.top) * static_cast<std::size_t>(box_.width());
    }

    template <class Profile>
    void add_near_line(Vec2 from, Vec2 to, float reach, Profile const& profile);

    PixelBox box_;
    std::vector<std::uint8_t> covered_;
    std::vector<float> area_;  // scratch of add_polygons()
};

}  // namespace pogosim
