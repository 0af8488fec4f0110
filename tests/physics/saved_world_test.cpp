// A world and the disk engine as bytes: another process moves them on to the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/random.hpp"
#include "base/state_bytes.hpp"
#include "base/worker_pool.hpp"
#include "physics/physics_engine.hpp"
#include "support/small_world.hpp"
#include "world/saved_world.hpp"

namespace pogosim {
namespace {

constexpr float kSideMm = 1500.0F;

/// A crowd of disks and rectangles, some fixed, some fast, around two membranes and a chain of springs that break.
World crowd(bool is_periodic) {
    World world = testing::square_world(kSideMm);
    world.periodic = is_periodic;
    RandomStream random(3, 0);
    for (std::uint32_t i = 0; i < 120; ++i) {
        ObjectSpec spec = testing::pogobot_spec();
        if (i % 5 == 1) {
            spec.shape = {.kind = ShapeKind::rectangle, .width_mm = 60.0F, .height_mm = 30.0F};
        }
        spec.body = BodySpec{.linear_damping = 0.1F, .friction = 0.3F, .restitution = 0.4F, .fixed = i % 20 == 7};
        Vec2 const place_mm{50.0F + 100.0F * static_cast<float>(i % 15), 50.0F + 70.0F * static_cast<float>(i / 15)};
        testing::add_body(world, place_mm, random.uniform(0.0F, 6.0F), spec);
        if (!spec.body->fixed) {
            float const speed_mm_s = i % 30 == 0 ? 5000.0F : 200.0F;
            world.bodies.velocity_mm_s[i] = speed_mm_s * direction(world.bodies.heading_rad[i]);
        }
    }
    for (std::uint32_t i = 30; i < 40; ++i) {
        world.links.push_back({.a = i,
                               .b = i + 1,
                               .end_a_mm = {},
                               .end_b_mm = {},
                               .length_mm = 90.0F,
                               .stiffness_n_m = 5.0F,
                               .breaking_n = 0.2F});
    }
    testing::add_ring(world, {.centre_mm = {400, 1100}, .radius_mm = 200.0F});
    testing::add_ring(world, {.centre_mm = {1000, 1100}, .radius_mm = 200.0F, .segments = true});
    return world;
}

class Moved {
public:
    explicit Moved(bool is_periodic)
        : world_(crowd(is_periodic)), engine_(make_physics_engine("disk", world_, {}, workers_)) {}

    void move(int steps) {
        for (int step = 0; step < steps; ++step) {
            engine_->advance(world_);
        }
    }

    std::vector<std::byte> bytes() const {
        StateWriter state;
        append_world(world_, state);
        engine_->append_state(state);
        return state.bytes();
    }

    void take(std::span<std::byte const> bytes) {
        StateReader state(bytes);
        take_world(world_, state);
        engine_->take_state(state);
        EXPECT_TRUE(state.rest().empty());
    }

    std::int64_t cut_links() const { return std::ranges::count_if(world_.links, &Link::is_cut); }

    friend bool operator==(Moved const& a, Moved const& b) {
        Bodies const& one = a.world_.bodies;
        Bodies const& other = b.world_.bodies;
        return one.position_mm == other.position_mm && one.heading_rad == other.heading_rad &&
               one.velocity_mm_s == other.velocity_mm_s && one.angular_velocity_rad_s == other.angular_velocity_rad_s &&
               a.world_.links == b.world_.links;
    }

private:
    WorkerPool workers_{1};
    World world_;
    std::unique_ptr<PhysicsEngine> engine_;
};

class SavedWorld : public ::testing::TestWithParam<bool> {};

TEST_P(SavedWorld, MovesOnToTheSameBits) {
    for (int const steps : {0, 1, 2, 7, 60}) {
        Moved one(GetParam());
        one.move(steps);
        Moved other(GetParam());
        other.move(steps % 3);  // what it was before is gone
        other.take(one.bytes());
        EXPECT_TRUE(other == one);
        for (int i = 0; i < 40; ++i) {
            one.move(1);
            other.move(1);
            ASSERT_TRUE(other == one) << steps << " steps, then " << i;
        }
        EXPECT_GT(one.cut_links(), 0);
    }
}

TEST_P(SavedWorld, EndsTooEarlyWhereverItIsCutOff) {
    Moved one(GetParam());
    one.move(3);
    std::vector<std::byte> const bytes = one.bytes();
    for (std::size_t size = 0; size < bytes.size(); size += bytes.size() / 50) {
        EXPECT_THROW(Moved(GetParam()).take(std::span<std::byte const>(bytes).first(size)), ForeignState) << size;
    }
}

INSTANTIATE_TEST_SUITE_P(, SavedWorld, ::testing::Bool(),
                         [](auto const& tested) { return tested.param ? "Periodic" : "Solid"; });

}  // namespace
}  // namespace pogosim
