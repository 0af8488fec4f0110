// Which disks can touch in the steps to come (a Verlet list): L. Verlet, "Computer 'experiments' on classical fluids
// I", Physical Review 159 (1967) 98, with cells as in R. W. Hockney and J. W. Eastwood, "Computer Simulation Using
// Particles" (1988), chapter 8.
//
// All pairs closer than a skin are looked for once, and stay valid until some body has moved half the skin.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec2.hpp"
#include "base/worker_pool.hpp"
#include "world/world.hpp"

namespace pogosim {

struct NearPair {
    std::uint32_t a;
    std::uint32_t b;
};

class NearPairs {
public:
    /// For bodies that are disks.
    explicit NearPairs(World const& world);

    /// Whether pairs() has all pairs whose disks are less than `reach_mm` apart now.
    bool covers(World const& world, float reach_mm, WorkerPool& workers) const;

    /// Looks for the pairs that are less than skin_mm() apart, which is more than `reach_mm`.
    void build(World const& world, float reach_mm, WorkerPool& workers);

    std::span<NearPair const> pairs() const { return pairs_; }
    float skin_mm() const { return skin_mm_; }

private:
    /// A copy of what the search needs, by cell.
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
    void find_around(std::uint32_t cell, std::vector<NearPair>& pairs) const;
    void find_between(std::uint32_t cell, std::uint32_t other, Vec2 shift_mm);
    void find_across_seams(Vec2 size_mm);
    void find_of_large(World const& world);
    void add_if_near(Item const& a, Item const& b, Vec2 shift_mm, std::vector<NearPair>& pairs) const;

    float skin_mm_ = 0.0F;
    float largest_mm_;                    // radius of those in the cells
    std::vector<std::uint32_t> large_;    // bodies that are larger, ascending
    std::vector<std::uint8_t> is_large_;  // or not in cells as these would be too few
    std::vector<std::uint8_t> is_fixed_;

    int columns_ = 1;
    int rows_ = 1;
    float columns_per_mm_ = 1.0F;
    float rows_per_mm_ = 1.0F;
    std::vector<std::uint32_t> cell_;   // of each body
    std::vector<std::uint32_t> start_;  // of each cell in items_, one more at the end
    std::vector<Item> items_;

    std::vector<Vec2> built_mm_;  // positions at build()
    std::vector<NearPair> pairs_;
    std::vector<std::vector<NearPair>> more_;  // of the second and further ranges of cells, while they are looked for
    bool is_built_ = false;
};

}  // namespace pogosim
