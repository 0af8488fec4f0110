// The outlines of walls and membranes, cut into short segments sorted by position, to find the outlines near a
// point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/grid.hpp"
#include "world/world.hpp"

namespace pogosim {

class OutlineIndex {
public:
    /// Takes the present outlines. Call once per step before the queries. Returns whether any outline has changed.
    bool update(World const& world);

    bool empty() const { return pieces_.empty(); }

    /// Bounding box of an outline.
    Box const& box(std::uint32_t outline) const { return boxes_[outline]; }

    /// A piece of an outline, relative to the centre of a query.
    struct Piece {
        Vec2 from;
        Vec2 to;
        std::uint32_t outline;  // index into World::outlines
    };

    /// Replaces `found` by the pieces within `radius_mm` of the centre, and some others.
    void find_near(World const& world, Vec2 centre, float radius_mm, std::vector<Piece>& found) const;

private:
    bool have_moved(World const& world);
    void add(Polygon const& polygon, std::uint32_t outline);

    std::size_t standing_ = 0;      // number of pieces of fixed outlines, which come first
    std::vector<Piece> pieces_;     // in world coordinates
    std::vector<Vec2> middles_;     // of the pieces
    std::vector<Box> boxes_;        // of the outlines
    float longest_half_mm_ = 0.0F;  // of all pieces
    std::vector<Vec2> dots_;        // bodies of the membranes at the last update
    UniformGrid grid_;
};

}  // namespace pogosim
