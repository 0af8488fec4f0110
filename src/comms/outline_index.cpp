#include "comms/outline_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/polygon.hpp"

namespace pogosim {

namespace {

constexpr float kPieceMm = 50.0F;  // longer edges are cut into pieces of about this length

}  // namespace

void OutlineIndex::add(Polygon const& polygon, std::uint32_t outline) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        Vec2 const from = polygon[i];
        Vec2 const edge = polygon[(i + 1) % polygon.size()] - from;
        float const count = std::max(1.0F, std::ceil(length(edge) / kPieceMm));
        for (float k = 0.0F; k < count; k += 1.0F) {
            Piece const piece{from + (k / count) * edge, from + ((k + 1.0F) / count) * edge, outline};
            pieces_.push_back(piece);
            middles_.push_back(0.5F * (piece.from + piece.to));
            longest_half_mm_ = std::max(longest_half_mm_, 0.5F * length(piece.to - piece.from));
        }
    }
    Box const around = bounding_box(polygon);
    Box& box = boxes_[outline];
    box.min = {std::min(box.min.x, around.min.x), std::min(box.min.y, around.min.y)};
    box.max = {std::max(box.max.x, around.max.x), std::max(box.max.y, around.max.y)};
}

bool OutlineIndex::have_moved(World const& world) {
    std::size_t count = 0;
    bool moved = false;
    for (Outline const& outline : world.outlines) {
        for (std::uint32_t i = outline.body; i < outline.body + outline.body_count; ++i, ++count) {
            if (count == dots_.size()) {
                dots_.emplace_back();
                moved = true;
            }
            moved = moved || dots_[count] != world.bodies.position_mm[i];
            dots_[count] = world.bodies.position_mm[i];
        }
    }
    return moved;
}

bool OutlineIndex::update(World const& world) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr Box nothing{{infinity, infinity}, {-infinity, -infinity}};
    if (world.outlines.empty()) {
        return false;
    }
    bool const is_first = boxes_.empty();
    if (!have_moved(world) && !is_first) {
        return false;
    }
    if (is_first) {
        boxes_.assign(world.outlines.size(), nothing);
        for (std::uint32_t i = 0; i < world.outlines.size(); ++i) {
            for (Polygon const& polygon : world.outlines[i].polygons) {
                add(polygon, i);
            }
        }
        standing_ = pieces_.size();
    }
    pieces_.resize(standing_);
    middles_.resize(standing_);
    for (std::uint32_t i = 0; i < world.outlines.size(); ++i) {
        Outline const& outline = world.outlines[i];
        if (outline.body_count > 0) {
            auto const first = world.bodies.position_mm.begin() + outline.body;
            boxes_[i] = nothing;
            add(Polygon(first, first + outline.body_count), i);
        }
    }
    grid_.build(middles_, world.arena.bounds, 2.0F * kPieceMm, world.periodic);
    return true;
}

void OutlineIndex::find_near(World const& world, Vec2 centre, float radius_mm, std::vector<Piece>& found) const {
    found.clear();
    float const search_mm = radius_mm + longest_half_mm_;
    grid_.for_each_near(centre, search_mm, [&](std::uint32_t i, Vec2 middle) {
        Vec2 const offset = minimum_image(world, centre, middle);
        if (squared_length(offset) <= search_mm * search_mm) {
            Piece const& piece = pieces_[i];
            found.push_back({offset + (piece.from - middle), offset + (piece.to - middle), piece.outline});
        }
    });
}

}  // namespace pogosim
