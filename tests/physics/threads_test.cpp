// The disk engine moves a world to the same bits, however many threads share the work.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/random.hpp"
#include "base/worker_pool.hpp"
#include "physics/physics_engine.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

template <class T>
bool has_same_bytes(std::vector<T> const& a, std::vector<T> const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// Disks of several sizes, some fixed, some so fast that they are swept, at random places, and soft membranes.
World crowd(std::uint32_t count, float side_mm, bool is_periodic) {
    constexpr float kFirstRingMm = 1000.0F;
    constexpr float kRingsApartMm = 2500.0F;
    constexpr float kRingRadiusMm = 300.0F;
    RandomStream random(5, 0);
    auto const is_on_ring = [&](Vec2 place_mm) {
        float const x_mm = kFirstRingMm + kRingsApartMm * std::round((place_mm.x - kFirstRingMm) / kRingsApartMm);
        return std::abs(length(place_mm - Vec2{x_mm, 0.5F * side_mm}) - kRingRadiusMm) < 75.0F;
    };
    auto const free_place_mm = [&] {
        for (;;) {
            Vec2 const place_mm{random.uniform(60.0F, side_mm - 60.0F), random.uniform(60.0F, side_mm - 60.0F)};
            if (!is_on_ring(place_mm)) {
                return place_mm;
            }
        }
    };
    World world = testing::square_world(side_mm);
    world.periodic = is_periodic;
    for (std::uint32_t i = 0; i < count; ++i) {
        ObjectSpec spec = testing::pogobot_spec();
        spec.shape.radius_mm = i % 100 == 0 ? 60.0F : 26.5F;
        spec.body = BodySpec{.linear_damping = 0.1F, .friction = 0.3F, .restitution = 0.4F, .fixed = i % 50 == 1};
        testing::add_body(world, free_place_mm(), random.uniform(0.0F, 6.0F), spec);
        if (!spec.body->fixed) {
            float const speed_mm_s = i % 30 == 0 ? 5000.0F : 100.0F;
            world.bodies.velocity_mm_s[i] = speed_mm_s * direction(world.bodies.heading_rad[i]);
        }
    }
    for (float x_mm = kFirstRingMm; x_mm < side_mm; x_mm += kRingsApartMm) {
        testing::add_ring(world, {.centre_mm = {x_mm, 0.5F * side_mm}, .radius_mm = kRingRadiusMm, .dots = 100});
    }
    return world;
}

class Threads : public ::testing::TestWithParam<bool> {};

Bodies moved_by(std::uint32_t threads, int steps, bool is_periodic) {
    World world = crowd(20000, 12000.0F, is_periodic);  // enough for several ranges of everything
    WorkerPool workers(threads);
    auto const engine = make_physics_engine("disk", world, {}, workers);
    for (int step = 0; step < steps; ++step) {
        engine->advance(world);
    }
    return world.bodies;
}

constexpr int kSteps = 10;

/// Share of the bodies that have moved from one place to the other.
double share_moved(Bodies const& from, Bodies const& to) {
    int moved = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        moved += from.position_mm[i] != to.position_mm[i] ? 1 : 0;
    }
    return static_cast<double>(moved) / static_cast<double>(from.size());
}

TEST(ThreadsTest, IsOfAWorldInWhichMostMoveAndMeetTheBorder) {
    Bodies const solid = moved_by(1, kSteps, false);
    EXPECT_GT(share_moved(moved_by(1, kSteps - 1, false), solid), 0.9);
    double const differ = share_moved(solid, moved_by(1, kSteps, true));
    EXPECT_GT(differ, 0.001);
    EXPECT_LT(differ, 0.5);
}

TEST_P(Threads, MoveAWorldToTheSameBits) {
    Bodies const expected = moved_by(1, kSteps, GetParam());
    for (std::uint32_t const threads : {2U, 3U, 8U}) {
        Bodies const bodies = moved_by(threads, kSteps, GetParam());
        EXPECT_TRUE(has_same_bytes(bodies.position_mm, expected.position_mm)) << threads;
        EXPECT_TRUE(has_same_bytes(bodies.heading_rad, expected.heading_rad)) << threads;
        EXPECT_TRUE(has_same_bytes(bodies.heading_dir, expected.heading_dir)) << threads;
        EXPECT_TRUE(has_same_bytes(bodies.velocity_mm_s, expected.velocity_mm_s)) << threads;
        EXPECT_TRUE(has_same_bytes(bodies.angular_velocity_rad_s, expected.angular_velocity_rad_s)) << threads;
    }
}

INSTANTIATE_TEST_SUITE_P(Arena, Threads, ::testing::Bool(),
                         [](::testing::TestParamInfo<bool> const& info) { return info.param ? "periodic" : "solid"; });

}  // namespace
}  // namespace pogosim
