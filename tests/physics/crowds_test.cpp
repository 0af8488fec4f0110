// Crowds: what many contacts at once must keep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/random.hpp"
#include "support/crowd_measures.hpp"
#include "support/each_engine.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::deepest_overlap_mm;
using testing::deepest_when_all_push_mm;
using testing::energy;
using testing::extremes_in;
using testing::make_engine;
using testing::square_world;

constexpr float kPi = std::numbers::pi_v<float>;

class Crowds : public testing::EachEngine {
protected:
    bool is_disk_engine() const { return GetParam() == "disk"; }
};

ObjectSpec disk(float radius_mm, float restitution, float friction = 0.0F) {
    ObjectSpec spec = testing::pogobot_spec();
    spec.shape.radius_mm = radius_mm;
    spec.body = BodySpec{.friction = friction, .restitution = restitution};
    return spec;
}

/// Disks on a hexagonal lattice that fills a box of so many columns and rows with this share of its area.
World packed(int columns, int rows, float coverage, float restitution) {
    constexpr float radius_mm = 26.5F;
    float const pitch_mm = radius_mm * std::sqrt(2.0F * kPi / (std::sqrt(3.0F) * coverage));
    float const row_mm = pitch_mm * std::sqrt(3.0F) / 2.0F;
    World world = square_world();
    Vec2 const size{pitch_mm * (static_cast<float>(columns) + 0.5F), row_mm * static_cast<float>(rows - 1) + pitch_mm};
    world.arena = make_arena({{{0, 0}, {size.x, 0}, {size.x, size.y}, {0, size.y}}});
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            float const x = pitch_mm * (static_cast<float>(column) + (row % 2 == 0 ? 0.5F : 1.0F));
            add_robot(world, {x, row_mm * static_cast<float>(row) + 0.5F * pitch_mm}, 0.0F,
                      disk(radius_mm, restitution));
        }
    }
    return world;
}

/// Whatever the speed: from a hundredth of a radius in a step to four diameters.
TEST_P(Crowds, FastGasDoesNotOverlap) {
    for (float const speed_mm_s : {30.0F, 1000.0F, 2000.0F, 5000.0F, 20000.0F}) {
        World world = packed(15, 15, 0.3F, 0.5F);
        RandomStream random(1, 0);
        auto const engine = make_engine(world, {});
        float deepest_mm = 0.0F;
        for (int step = 0; step < 200; ++step) {
            if (step % 10 == 0) {
                for (Vec2& velocity : world.bodies.velocity_mm_s) {
                    velocity = speed_mm_s * direction(random.uniform(-kPi, kPi));
                }
            }
            engine->advance(world);
            deepest_mm = std::max(deepest_mm, deepest_overlap_mm(world));
        }
        EXPECT_LT(deepest_mm, is_disk_engine() ? 1.2F : 6.0F) << speed_mm_s << " mm/s";
    }
}

/// A before something fixed, and B behind A, both fast.
TEST_P(Crowds, BodyThatFollowsAStoppedOneStopsBehindIt) {
    for (float const gap_mm : {1.0F, 30.0F}) {
        for (float const speed_mm_s : {1000.0F, 6000.0F, 15000.0F}) {
            World world = square_world(4000.0F);
            ObjectSpec wall = disk(26.5F, 0.0F);
            wall.body->fixed = true;
            add_robot(world, {3000, 2000}, 0.0F, wall);
            add_robot(world, {3000 - 53 - gap_mm, 2000}, 0.0F, disk(26.5F, 0.0F));
            add_robot(world, {3000 - 106 - 2 * gap_mm, 2000}, 0.0F, disk(26.5F, 0.0F));
            auto const engine = make_engine(world, {});
            for (std::uint32_t const body : {1U, 2U}) {
                set_velocity(world.bodies, body, {speed_mm_s, 0}, 0.0F);
            }
            for (int step = 0; step < 30; ++step) {
                engine->advance(world);
                EXPECT_LT(deepest_overlap_mm(world), is_disk_engine() ? 0.5F : 7.0F)
                    << speed_mm_s << " mm/s, gaps of " << gap_mm << " mm, step " << step;
            }
        }
    }
}

TEST_P(Crowds, DenseGasDoesNotOverlapNorGainEnergy) {
    for (float const restitution : {0.0F, 0.5F, 1.0F}) {
        World world = packed(20, 20, 0.8F, restitution);
        RandomStream random(1, 0);
        for (Vec2& velocity : world.bodies.velocity_mm_s) {
            velocity = 60.0F * direction(random.uniform(-kPi, kPi));
        }
        auto const engine = make_engine(world, {.friction = 0.0F, .restitution = restitution});
        double const before = energy(world);
        auto const [highest, deepest_mm] = extremes_in(world, *engine, 500);
        EXPECT_LT(deepest_mm, is_disk_engine() ? 0.5F : 2.5F) << restitution;
        EXPECT_LT(highest, 1.001 * before) << restitution;
        if (restitution == 1.0F) {
            EXPECT_GT(energy(world), 0.9 * before);
        }
    }
}

TEST_P(Crowds, RobotsThatAllPushToOneSideStayApart) {
    World world = packed(20, 20, 0.8F, 0.5F);
    auto const engine = make_engine(world, {});
    float const deepest_mm = deepest_when_all_push_mm(world, *engine, {50.0F, 0.0F}, 500);
    EXPECT_LT(deepest_mm, is_disk_engine() ? 0.5F : 6.0F);
}

POGOSIM_FOR_EACH_ENGINE(Crowds);

}  // namespace
}  // namespace pogosim
