// The pairs of disks that can touch in the coming steps (a Verlet list): L. Verlet, "Computer 'experiments' on
// classical fluids I", Physical Review 159 (1967) 98, with cells as in R. W. Hockney and J. W. Eastwood, "Computer
// Simulation Using Particles" (1988), chapter 8.
//
// All pairs closer than a skin are found once, and the list stays valid until a body has moved by half the skin.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec2.hpp"
#include "base/worker_pool.hpp"
#include "world/world.hpp"

namespace pogosim {

struct NeighbourPair {
    std::uint32_t a;
    std::uint32_t b;
};

class NeighbourList {
public:
    /// For bodies that are disks.
    explicit NeighbourList(World const& world);

    /// Whether pairs() has all pairs of disks that are now less than `reach_mm` apart.
    bool covers(World const& world, float reach_mm, WorkerPool& workers) const;

    /// Finds all pairs that are less than skin_mm() apart, which is more than `reach_mm`.
    void build(World const& world, float reach_mm, WorkerPool& workers);

    std::span<NeighbourPair const> pairs() const { return pairs_; }
    float skin_mm() const { return skin_mm_; }

    /// What later steps depend on, see state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.skin_mm_, self.built_mm_, self.pairs_, self.is_built_);
    }

private:
    /// A body in the copy that the search works on, which is sorted by cell.
    struct Item {
        Vec2 position_mm;
        float radius_mm;
        std::uint32_t body;
    };

    std::uint32_t cell_at(World const& world, Vec2 point_mm) const;
    void lay_cells(World const& world);
    void sort_into_cells(World const& world);
    template <class Visit>
    void for_each_row_near(World const& world, Item const& disk, Visit const& visit) const;
    void find_in_cells(WorkerPool& workers);
    void find_around(std::uint32_t cell, std::vector<NeighbourPair>& pairs) const;
    void find_between(std::uint32_t cell, std::uint32_t other, Vec2 shift_mm);
    void find_across_seams(Vec2 size_mm);
    void find_of_large(World const& world);
    bool are_near(Item const& a, Item const& b, Vec2 shift_mm) const;
    void add_if_near(Item const& a, Item const& b, Vec2 shift_mm);

    float skin_mm_ = 0.0F;
    float largest_mm_;                    // largest radius in the cells
    std::vector<std::uint32_t> large_;    // larger bodies, ascending
    std::vector<std::uint8_t> is_large_;  // or all, if there would be too few cells
    std::vector<std::uint8_t> is_fixed_;

    int columns_ = 1;
    int rows_ = 1;
    float columns_per_mm_ = 1.0F;
    float rows_per_mm_ = 1.0F;
    std::vector<std::uint32_t> cell_;   // of each body
    std::vector<std::uint32_t> start_;  // of each cell in items_, and the end
    std::vector<Item> items_;

    std::vector<Vec2> built_mm_;  // positions at build()
    std::vector<NeighbourPair> pairs_;
    std::vector<std::vector<NeighbourPair>> more_;  // of the second and further ranges of cells, during the search
    bool is_built_ = false;
};

}  // namespace pogosim
