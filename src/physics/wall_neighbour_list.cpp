#include "physics/wall_neighbour_list.hpp"

#include <algorithm>

namespace pogosim {

WallNeighbourList::WallNeighbourList(World const& world, WallIndex const& walls)
    : sides_(std::make_shared<WallSides const>(world.periodic ? WallSides() : sides_of(walls))) {}

void WallNeighbourList::build(World const& world, PositionCorrection const& places, float skin_mm) {
    near_.clear();
    if (sides_->empty()) {
        return;
    }
    Bodies const& bodies = world.bodies;
    for (std::uint32_t body = 0; body < bodies.size(); ++body) {
        float const reach_mm = bodies.radius_mm[body] + skin_mm;
        if (bodies.spec[body].fixed || places.free_mm(body) > reach_mm) {
            continue;
        }
        Vec2 const place_mm = bodies.position_mm[body];
        found_.clear();
        places.walls().for_each_near(place_mm, reach_mm, [&](WallEdge const& edge) {
            if (distance_to(side(edge.number), place_mm) < reach_mm &&
                std::ranges::find(found_, edge.number) == found_.end()) {
                found_.push_back(edge.number);
            }
        });
        std::ranges::sort(found_);
        for (std::uint32_t const edge : found_) {
            near_.push_back({body, edge});
        }
    }
}

}  // namespace pogosim
