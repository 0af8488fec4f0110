#include "render/canvas.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "render/blend.hpp"
#include "render/polygon_area.hpp"

namespace pogosim {

namespace {

/// About the share of a pixel at distance d from a pen's middle that a pen of half width h covers, in any direction.
float pen(float d, float h) {
    return clamp01(h + 0.5F + d) - clamp01(d - h + 0.5F);
}

/// The exact share of a pixel that a straight stripe covers, by the direction of the stripe, a unit vector: across it,
/// a unit square is a trapezoid.
class Stripe {
public:
    explicit Stripe(Vec2 unit)
        : outer_(0.5F * (std::abs(unit.x) + std::abs(unit.y))),
          inner_(0.5F * std::abs(std::abs(unit.x) - std::abs(unit.y))),
          height_(1.0F / (outer_ + inner_)),
          bend_(outer_ - inner_ > 1e-4F ? 0.5F * height_ / (outer_ - inner_) : 0.0F) {}

    /// The share of a pixel covered at distance d from the middle of a stripe of half width h.
    float covered(float d, float h) const { return below(d + h) - below(d - h); }

private:
    /// Share of the square up to a distance x from its centre.
    float below(float x) const {
        float const away = std::abs(x);
        float const rest = std::max(outer_ - away, 0.0F);
        float const beyond = away > inner_ ? bend_ * rest * rest : 0.5F - height_ * away;
        return x < 0.0F ? beyond : 1.0F - beyond;
    }

    float outer_;
    float inner_;
    float height_;
    float bend_;
};

Vec2 unit_along(Vec2 along) {
    float const size = length(along);
    return size > 1e-6F ? (1.0F / size) * along : Vec2{1.0F, 0.0F};
}

constexpr float kHalfDiagonal = 0.71F;  // of a pixel

/// Whether the number and its square are finite.
bool is_sound(float length) {
    return std::abs(length) <= 1e9F;
}

bool is_sound(Vec2 point) {
    return is_sound(point.x) && is_sound(point.y);
}

bool are_sound(std::span<Vec2 const> points) {
    return std::all_of(points.begin(), points.end(), [](Vec2 point) { return is_sound(point); });
}

/// Pixels whose centres lie between two numbers.
struct Span {
    int first;
    int end;
};

Span centres_between(float low, float high, int first, int end) {
    return {floor_within(std::ceil(low - 0.5F), first, end), floor_within(high + 0.5F, first, end)};
}

/// Pixels of a row, `down` below the centre of a disk, whose centres are in it.
Span columns_of_disk(float centre_x, float radius, float down, int first, int end) {
    float const reach = std::sqrt(std::max(radius * radius - down * down, 0.0F));
    return centres_between(centre_x - reach, centre_x + reach, first, end);
}

/// The interval of numbers t with |slope t + offset - middle| <= half, cut out of one that is there.
struct Interval {
    float low = -std::numeric_limits<float>::infinity();
    float high = std::numeric_limits<float>::infinity();

    void keep(float slope, float offset, float least, float most) {
        if (std::abs(slope) < 1e-6F) {
            if (offset < least || offset > most) {
                high = low - 1.0F;
            }
            return;
        }
        float a = (least - offset) / slope;
        float b = (most - offset) / slope;
        if (a > b) {
            std::swap(a, b);
        }
        low = std::max(low, a);
        high = std::min(high, b);
    }
};

struct Segment {
    Vec2 from;
    Vec2 to;
};

/// The part of a segment in and near a box, so that pixels can be counted along it; nothing if it passes by.
std::optional<Segment> near_box(Vec2 from, Vec2 to, PixelBox const& box, float reach) {
    double const low[2] = {static_cast<double>(box.left) - reach, static_cast<double>(box.top) - reach};
    double const high[2] = {static_cast<double>(box.right) + reach, static_cast<double>(box.bottom) + reach};
    double const start[2] = {from.x, from.y};
    double const step[2] = {static_cast<double>(to.x) - from.x, static_cast<double>(to.y) - from.y};
    double first = 0.0;
    double last = 1.0;
    for (int axis = 0; axis < 2; ++axis) {
        if (step[axis] == 0.0) {
            if (start[axis] < low[axis] || start[axis] > high[axis]) {
                return std::nullopt;
            }
            continue;
        }
        double const a = (low[axis] - start[axis]) / step[axis];
        double const b = (high[axis] - start[axis]) / step[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    if (!(first <= last)) {
        return std::nullopt;
    }
    auto const at = [&](double share, Vec2 end) {
        return share == 0.0 || share == 1.0 ? end
                                            : Vec2{static_cast<float>(start[0] + share * step[0]),
                                                   static_cast<float>(start[1] + share * step[1])};
    };
    return Segment{at(first, from), at(last, to)};
}

/// Calls visit(y, x, u, v) for the pixels of a box whose centres are at most `reach` beside the segment and at most
/// `beyond` behind its ends; u is the distance to the right of it, v that along it from its start.
template <class Visit>
void for_each_near(Segment const& segment, float reach, float beyond, PixelBox const& box, Visit const& visit) {
    Vec2 const along = segment.to - segment.from;
    float const size = length(along);
    Vec2 const unit = unit_along(along);
    float const extent = std::hypot(reach, beyond);
    float const top = std::min(segment.from.y, segment.to.y) - extent;
    float const bottom = std::max(segment.from.y, segment.to.y) + extent;
    Span const rows = centres_between(top, bottom, box.top, box.bottom);
    for (int y = rows.first; y < rows.end; ++y) {
        float const down = static_cast<float>(y) + 0.5F - segment.from.y;
        Interval x;
        x.keep(-unit.y, down * unit.x, -reach, reach);
        x.keep(unit.x, down * unit.y, -beyond, size + beyond);
        if (!(x.low <= x.high)) {
            continue;
        }
        Span const columns = centres_between(segment.from.x + x.low, segment.from.x + x.high, box.left, box.right);
        for (int column = columns.first; column < columns.end; ++column) {
            float const right = static_cast<float>(column) + 0.5F - segment.from.x;
            visit(y, column, down * unit.x - right * unit.y, right * unit.x + down * unit.y);
        }
    }
}

/// Distance from a segment that starts at v = 0.
float distance_from(float u, float v, float size) {
    float const past = v < 0.0F ? v : std::max(v - size, 0.0F);
    return past == 0.0F ? std::abs(u) : std::sqrt(u * u + past * past);
}

/// The radius of the disk that, drawn with a soft edge one pixel wide, has the area that was asked for; a smaller one
/// than `kLeastRadius` is drawn with that, and fainter.
constexpr float kLeastRadius = 0.8F;

struct SoftDisk {
    float radius;
    float share;  // of the opacity
};

SoftDisk soft_disk(float radius) {
    float const drawn = std::max(radius, kLeastRadius);
    float const share = radius < kLeastRadius ? radius * radius / (kLeastRadius * kLeastRadius) : 1.0F;
    return {std::sqrt(drawn * drawn - 1.0F / 12.0F), share};
}

}  // namespace

PixelBox intersection(PixelBox const& a, PixelBox const& b) {
    return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

PixelBox pixels_of(Box const& box_px, PixelBox const& within) {
    return {floor_within(box_px.min.x, within.left, within.right),
            floor_within(box_px.min.y, within.top, within.bottom),
            floor_within(std::ceil(box_px.max.x), within.left, within.right),
            floor_within(std::ceil(box_px.max.y), within.top, within.bottom)};
}

Canvas::Canvas(PictureSize size) {
    resize(size);
}

void Canvas::resize(PictureSize size) {
    PictureSize const wanted{std::max(size.width_px, 0), std::max(size.height_px, 0)};
    size_ = {0, 0};  // until there is memory for it
    pixels_.assign(static_cast<std::size_t>(wanted.width_px) * static_cast<std::size_t>(wanted.height_px), 0xFF000000U);
    size_ = wanted;
    clip_ = bounds();
}

void Canvas::fill(Pixel colour) {
    for (int y = clip_.top; y < clip_.bottom; ++y) {
        std::fill(row(y) + clip_.left, row(y) + std::max(clip_.right, clip_.left), colour | 0xFF000000U);
    }
}

void Canvas::clear() {
    std::ranges::fill(pixels_, 0U);
}

void Canvas::lay_over(Canvas const& layer) {
    assert(layer.size() == size_);
    for (int y = clip_.top; y < clip_.bottom; ++y) {
        Pixel* const below = row(y);
        Pixel const* const above = layer.pixels().data() + (below - pixels_.data());
        for (int x = clip_.left; x < clip_.right; ++x) {
            if (Pixel const over = above[x]; over != 0) {
                std::uint32_t const alpha = over >> 24U;
                std::uint32_t const rest = 256U - alpha - (alpha >> 7U);
                std::uint32_t const red_blue = ((below[x] & 0xFF00FFU) * rest + 0x800080U) >> 8U;
                std::uint32_t const alpha_green = ((below[x] >> 8U) & 0xFF00FFU) * rest + 0x800080U;
                // Rounding must not carry into the next channel.
                below[x] = saturated_sum((red_blue & 0xFF00FFU) | (alpha_green & 0xFF00FF00U), over);
            }
        }
    }
}

void Canvas::disk(Vec2 centre, float radius, Pixel colour) {
    if (!is_sound(centre) || !is_sound(radius) || radius <= 0.0F) {
        return;
    }
    SoftDisk const soft = soft_disk(radius);
    float const opacity = soft.share * opacity_of(colour);
    auto const whole = static_cast<std::uint32_t>(opacity + 0.5F);
    float const outer = soft.radius + 0.5F;
    float const inner = soft.radius - 0.5F;
    Span const rows = centres_between(centre.y - outer, centre.y + outer, clip_.top, clip_.bottom);
    for (int y = rows.first; y < rows.end; ++y) {
        float const down = static_cast<float>(y) + 0.5F - centre.y;
        Span const touched = columns_of_disk(centre.x, outer, down, clip_.left, clip_.right);
        Span full{touched.end, touched.end};
        if (inner > std::abs(down)) {
            full = columns_of_disk(centre.x, inner, down, touched.first, touched.end);
        }
        Pixel* const pixel = row(y);
        auto const edge = [&](int first, int end) {
            for (int x = first; x < end; ++x) {
                float const right = static_cast<float>(x) + 0.5F - centre.x;
                blend(pixel[x], colour, clamp01(outer - std::sqrt(right * right + down * down)), opacity);
            }
        };
        if (full.first >= full.end) {
            edge(touched.first, touched.end);
            continue;
        }
        edge(touched.first, full.first);
        if (whole == 256U) {
            std::fill(pixel + full.first, pixel + full.end, colour);
        } else {
            for (int x = full.first; x < full.end; ++x) {
                pixel[x] = blended(pixel[x], colour, whole);
            }
        }
        edge(full.end, touched.end);
    }
}

void Canvas::half_disk(Vec2 centre, float radius, Vec2 facing, Pixel colour) {
    if (!is_sound(centre) || !is_sound(facing) || !is_sound(radius) || radius <= 0.0F) {
        return;
    }
    SoftDisk const soft = soft_disk(radius);
    float const opacity = soft.share * opacity_of(colour);
    float const outer = soft.radius + 0.5F;
    Span const rows = centres_between(centre.y - outer, centre.y + outer, clip_.top, clip_.bottom);
    for (int y = rows.first; y < rows.end; ++y) {
        float const down = static_cast<float>(y) + 0.5F - centre.y;
        Span const touched = columns_of_disk(centre.x, outer, down, clip_.left, clip_.right);
        for (int x = touched.first; x < touched.end; ++x) {
            float const right = static_cast<float>(x) + 0.5F - centre.x;
            float const side = clamp01(right * facing.x + down * facing.y + 0.5F);
            blend(row(y)[x], colour, side * clamp01(outer - std::sqrt(right * right + down * down)), opacity);
        }
    }
}

void Canvas::ring(Vec2 centre, float radius, float width, Pixel colour) {
    if (!is_sound(centre) || !is_sound(radius) || !is_sound(width) || radius <= 0.0F || width <= 0.0F) {
        return;
    }
    float const half = 0.5F * width;
    float const outer = radius + half + 0.5F;
    float const inner = radius - half - 0.5F;
    float const opacity = opacity_of(colour);
    Span const rows = centres_between(centre.y - outer, centre.y + outer, clip_.top, clip_.bottom);
    for (int y = rows.first; y < rows.end; ++y) {
        float const down = static_cast<float>(y) + 0.5F - centre.y;
        Span const touched = columns_of_disk(centre.x, outer, down, clip_.left, clip_.right);
        Span hole{touched.end, touched.end};
        if (inner > std::abs(down)) {
            hole = columns_of_disk(centre.x, inner, down, touched.first, touched.end);
        }
        auto const draw = [&](int first, int end) {
            for (int x = first; x < end; ++x) {
                float const right = static_cast<float>(x) + 0.5F - centre.x;
                float const distance = std::sqrt(right * right + down * down);
                blend(row(y)[x], colour, pen(distance - radius, half), opacity);
            }
        };
        draw(touched.first, std::max(hole.first, touched.first));
        draw(std::max(hole.end, hole.first), touched.end);
    }
}

void Canvas::line(Vec2 from, Vec2 to, float width, Cap cap, Pixel colour) {
    if (!is_sound(from) || !is_sound(to) || !is_sound(width) || width <= 0.0F) {
        return;
    }
    float const half = 0.5F * width;
    auto const segment = near_box(from, to, clip_, width + 2.0F);
    if (!segment) {
        return;
    }
    float const size = length(segment->to - segment->from);
    float const opacity = opacity_of(colour);
    Stripe const stripe(unit_along(segment->to - segment->from));
    float const reach = half + kHalfDiagonal;
    if (cap == Cap::butt) {
        for_each_near(*segment, reach, kHalfDiagonal, clip_, [&](int y, int x, float u, float v) {
            bool const is_near_end = v < kHalfDiagonal || v > size - kHalfDiagonal;
            float const along = is_near_end ? stripe.covered(v - 0.5F * size, 0.5F * size) : 1.0F;
            blend(row(y)[x], colour, stripe.covered(u, half) * along, opacity);
        });
    } else {
        for_each_near(*segment, reach, reach, clip_, [&](int y, int x, float u, float v) {
            bool const is_beside = v >= 0.0F && v <= size;
            float const share = is_beside ? stripe.covered(u, half) : pen(distance_from(u, v, size), half);
            blend(row(y)[x], colour, share, opacity);
        });
    }
}

void Canvas::chain_link(Vec2 from, Vec2 to, float width, Pixel colour) {
    // Where the line goes near the borders, it is cut off in front of them; what lies farther out is not drawn.
    if (!(width > 0.0F)) {
        return;
    }
    float const reach = width + 2.0F;
    auto const is_well_inside = [&](Vec2 point) {
        return point.x >= static_cast<float>(clip_.left) + reach && point.x < static_cast<float>(clip_.right) - reach &&
               point.y >= static_cast<float>(clip_.top) + reach && point.y < static_cast<float>(clip_.bottom) - reach;
    };
    if (!is_well_inside(from) || !is_well_inside(to)) {
        line(from, to, width, Cap::butt, colour);
        return;
    }
    bool const is_flat = std::abs(to.x - from.x) >= std::abs(to.y - from.y);
    Vec2 start = is_flat ? from : Vec2{from.y, from.x};
    Vec2 end = is_flat ? to : Vec2{to.y, to.x};
    if (start.x > end.x) {
        std::swap(start, end);
    }
    // The line covers one piece of each column (or row) of pixels whose middle it passes. At its ends it takes the
    // middle at the start: the other one is taken by the next piece of the chain. In 1/65536 of a pixel.
    auto const first = static_cast<int>(start.x + 0.5F);
    auto const last = static_cast<int>(end.x + 0.5F);
    if (first >= last) {
        return;
    }
    constexpr float kOne = 65536.0F;
    constexpr std::int32_t kFraction = 0xFFFF;
    float const slope = (end.y - start.y) / (end.x - start.x);
    auto const thickness = static_cast<std::int32_t>(kOne * width * std::sqrt(1.0F + slope * slope));
    auto const slope_fixed = static_cast<std::int32_t>(kOne * slope);
    float const middle = start.y + slope * (static_cast<float>(first) + 0.5F - start.x);
    std::int32_t low = static_cast<std::int32_t>(kOne * middle) - thickness / 2;
    auto const opacity = static_cast<std::int32_t>(opacity_of(colour) + 0.5F);
    auto const blend_part = [&](Pixel& pixel, std::int32_t covered) {
        pixel = blended(pixel, colour, static_cast<std::uint32_t>((covered * opacity + 0x8000) >> 16));
    };
    std::ptrdiff_t const across = is_flat ? size_.width_px : 1;
    std::ptrdiff_t const along = is_flat ? 1 : size_.width_px;
    Pixel* column = pixels_.data() + first * along;
    for (int k = first; k < last; ++k, low += slope_fixed, column += along) {
        std::int32_t const high = low + thickness;
        Pixel* pixel = column + (low >> 16) * across;
        Pixel* const end_pixel = column + (high >> 16) * across;
        if (pixel == end_pixel) {
            blend_part(*pixel, thickness);
            continue;
        }
        blend_part(*pixel, kFraction + 1 - (low & kFraction));
        for (pixel += across; pixel != end_pixel; pixel += across) {
            blend_part(*pixel, kFraction + 1);
        }
        blend_part(*pixel, high & kFraction);
    }
}

void Canvas::polygon(std::span<Vec2 const> corners, Pixel colour) {
    if (corners.empty() || !are_sound(corners)) {
        return;
    }
    Box around{corners[0], corners[0]};
    for (Vec2 const corner : corners) {
        around.min = {std::min(around.min.x, corner.x), std::min(around.min.y, corner.y)};
        around.max = {std::max(around.max.x, corner.x), std::max(around.max.y, corner.y)};
    }
    PixelBox const box = pixels_of(around, clip_);
    float const opacity = opacity_of(colour);
    int const rows = rows_at_once(box);
    for (int top = box.top; top < box.bottom; top += rows) {
        PolygonArea area({box.left, top, box.right, std::min(top + rows, box.bottom)}, area_);
        area.add(corners);
        area.for_each_covered(
            [&](int y, int x, float coverage) { blend(row(y)[box.left + x], colour, coverage, opacity); });
    }
}

void Canvas::glow(Vec2 centre, float radius, Pixel colour, Coverage const& within) {
    if (!is_sound(centre) || !is_sound(radius) || radius < 0.1F) {
        return;
    }
    float const scale = 1.0F / (radius * radius);
    float const opacity = opacity_of(colour) / 255.0F;
    PixelBox const box = intersection(clip_, within.box());
    if (box.width() == 0) {
        return;
    }
    Span const rows = centres_between(centre.y - radius, centre.y + radius, box.top, box.bottom);
    for (int y = rows.first; y < rows.end; ++y) {
        float const down = static_cast<float>(y) + 0.5F - centre.y;
        float const reach = std::sqrt(std::max(radius * radius - down * down, 0.0F));
        Span const columns = centres_between(centre.x - reach, centre.x + reach, box.left, box.right);
        float const base = 1.0F - down * down * scale;
        Pixel* const pixel = row(y);
        std::uint8_t const* const covered = within.row(y) - within.box().left;
        for (int x = columns.first; x < columns.end; ++x) {
            float const right = static_cast<float>(x) + 0.5F - centre.x;
            float const rest = std::max(base - right * right * scale, 0.0F);
            float const share = rest * rest * opacity * static_cast<float>(covered[x]);
            pixel[x] = blended(pixel[x], colour, rounded(share));
        }
    }
}

void Canvas::cover(Coverage const& coverage, Pixel colour) {
    PixelBox const box = intersection(clip_, coverage.box());
    if (box.width() == 0) {
        return;
    }
    float const opacity = opacity_of(colour) / 255.0F;
    for (int y = box.top; y < box.bottom; ++y) {
        Pixel* const pixel = row(y);
        std::uint8_t const* const covered = coverage.row(y) - coverage.box().left;
        for (int x = box.left; x < box.right; ++x) {
            if (covered[x] != 0) {
                blend(pixel[x], colour, static_cast<float>(covered[x]), opacity);
            }
        }
    }
}

void Canvas::stamp(std::uint8_t const* opacity, int width, int height, int stride, int left, int top, Pixel colour) {
    PixelBox const box = intersection(clip_, {left, top, left + width, top + height});
    float const share = opacity_of(colour) / 255.0F;
    for (int y = box.top; y < box.bottom; ++y) {
        Pixel* const pixel = row(y);
        std::uint8_t const* const from = opacity + static_cast<std::ptrdiff_t>(y - top) * stride;
        for (int x = box.left; x < box.right; ++x) {
            blend(pixel[x], colour, static_cast<float>(from[x - left]), share);
        }
    }
}

void Coverage::reset(PixelBox const& box) {
    box_ = box;
    covered_.assign(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()), 0);
}

void Coverage::add_polygons(std::span<std::vector<Vec2> const> polygons) {
    int const rows = rows_at_once(box_);
    for (int top = box_.top; top < box_.bottom; top += rows) {
        PolygonArea area({box_.left, top, box_.right, std::min(top + rows, box_.bottom)}, area_);
        for (auto const& polygon : polygons) {
            if (are_sound(polygon)) {
                area.add(polygon);
            }
        }
        area.for_each_covered([&](int y, int x, float coverage) {
            auto& covered = covered_[offset(y) + static_cast<std::size_t>(x)];
            covered = std::max(covered, static_cast<std::uint8_t>(coverage * 255.0F + 0.5F));
        });
    }
}

template <class Profile>
void Coverage::add_near_line(Vec2 from, Vec2 to, float reach, Profile const& profile) {
    if (!is_sound(from) || !is_sound(to) || !is_sound(reach) || reach <= 0.0F) {
        return;
    }
    auto const segment = near_box(from, to, box_, reach + 2.0F);
    if (!segment) {
        return;
    }
    float const size = length(segment->to - segment->from);
    for_each_near(*segment, reach, reach, box_, [&](int y, int x, float u, float v) {
        auto& covered = covered_[offset(y) + static_cast<std::size_t>(x - box_.left)];
        auto const level = static_cast<std::uint8_t>(profile(distance_from(u, v, size)) * 255.0F + 0.5F);
        covered = std::max(covered, level);
    });
}

void Coverage::add_line(Vec2 from, Vec2 to, float width) {
    float const half = 0.5F * width;
    add_near_line(from, to, half + 0.5F, [&](float distance) { return pen(distance, half); });
}

void Coverage::add_glow(Vec2 from, Vec2 to, float width) {
    float const half = 0.5F * width;
    add_near_line(from, to, half, [&](float distance) {
        float const rest = std::max(1.0F - distance / half, 0.0F);
        return rest * rest;
    });
}

void Coverage::keep_within(Coverage const& other) {
    for (int y = box_.top; y < box_.bottom; ++y) {
        bool const has_row = y >= other.box_.top && y < other.box_.bottom;
        for (int x = box_.left; x < box_.right; ++x) {
            bool const has_pixel = has_row && x >= other.box_.left && x < other.box_.right;
            unsigned const share = has_pixel ? other.row(y)[x - other.box_.left] : 0U;
            auto& covered = covered_[offset(y) + static_cast<std::size_t>(x - box_.left)];
            covered = static_cast<std::uint8_t>((covered * share + 127U) / 255U);
        }
    }
}

}  // namespace pogosim
