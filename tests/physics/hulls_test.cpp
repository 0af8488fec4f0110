// Rectangles and triangles that move: where they touch, and what crowds of them must keep.
#include "physics/hulls.hpp"
#include "physics/manifold.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "geometry/wall_index.hpp"
#include "support/crowd_measures.hpp"
#include "support/each_engine.hpp"
#include "support/shapes.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_body;
using testing::capsule;
using testing::deepest_overlap_mm;
using testing::deepest_when_all_push_mm;
using testing::disk;
using testing::energy;
using testing::extremes_in;
using testing::hull_at;
using testing::make_engine;
using testing::octagon;
using testing::polygon;
using testing::rectangle;
using testing::rounded;
using testing::square_world;
using testing::triangle;

constexpr float kPi = std::numbers::pi_v<float>;

class MovingHulls : public testing::EachEngine {
protected:
    bool is_ours() const { return GetParam() == "disk"; }
};

double distance_mm(Vec2 from, Vec2 to, Vec2 point) {
    double const x = to.x - from.x;
    double const y = to.y - from.y;
    double const squared = x * x + y * y;
    double const t =
        squared > 0.0 ? std::clamp(((point.x - from.x) * x + (point.y - from.y) * y) / squared, 0.0, 1.0) : 0.0;
    return std::hypot(from.x + t * x - point.x, from.y + t * y - point.y);
}

/// From the corners and sides of both, without the normals.
double distance_mm(Hull const& a, Hull const& b) {
    double nearest_mm = 1e9;
    for (auto const& [corners, sides] : {std::pair(a, b), std::pair(b, a)}) {
        for (std::uint32_t i = 0; i < corners.count; ++i) {
            for (std::uint32_t k = 0; k < sides.count; ++k) {
                nearest_mm = std::min(nearest_mm,
                                      distance_mm(sides.corner_mm[k], sides.next_corner_mm(k), corners.corner_mm[i]));
            }
        }
    }
    return nearest_mm - a.radius_mm - b.radius_mm;
}

Shape any_shape(RandomStream& random, bool with_disks) {
    switch (static_cast<int>(random.uniform(0.0F, with_disks ? 6.99F : 5.99F))) {
        case 0:
            return rectangle(random.uniform(2.0F, 120.0F), random.uniform(2.0F, 60.0F));
        case 1:
            return triangle(random.uniform(5.0F, 100.0F));
        case 2:
            return capsule(random.uniform(2.0F, 120.0F), random.uniform(2.0F, 60.0F));
        case 3:
            return octagon(random.uniform(5.0F, 100.0F));
        case 4:
            return rounded(rectangle(random.uniform(20.0F, 120.0F), random.uniform(20.0F, 60.0F)), 8.0F);
        case 5:
            return polygon({{-30.0F, 0.0F}, {0.0F, -random.uniform(1.0F, 50.0F)}, {25.0F, -0.5F}, {8.0F, 22.0F}},
                           random.uniform(0.0F, 0.4F));
        default:
            return disk(random.uniform(1.0F, 50.0F));
    }
}

TEST(Hull, TouchesOthersWhereTheirOutlinesAreNearest) {
    RandomStream random(3, 0);
    int apart = 0;
    for (int i = 0; i < 20000; ++i) {
        Hull const a = hull_at(any_shape(random, false), {}, random.uniform(-kPi, kPi));
        Vec2 const place_mm = random.uniform(0.0F, 150.0F) * direction(random.uniform(-kPi, kPi));
        Hull const b = hull_at(any_shape(random, true), place_mm, random.uniform(-kPi, kPi));
        float const gap_mm = gap_between_mm(a, b);
        Manifold const touches = touches_of(a, b, 1000.0F);
        ASSERT_GE(touches.count, 1U);
        ASSERT_NEAR(length(touches.normal), 1.0F, 1e-4F);
        float nearest_mm = touches.touch[0].gap_mm;
        nearest_mm = touches.count == 2 ? std::min(nearest_mm, touches.touch[1].gap_mm) : nearest_mm;
        bool const cores_are_apart = gap_mm + a.radius_mm + b.radius_mm > 0.0F;
        if (cores_are_apart) {
            ++apart;
            EXPECT_NEAR(gap_mm, distance_mm(a, b), 1e-3) << i;
        }
        // Away from the other one along the normal, they just touch, whether they overlapped or not.
        Hull const moved = placed(a, -gap_mm * touches.normal, {1.0F, 0.0F});
        EXPECT_NEAR(gap_between_mm(moved, b), 0.0F, 0.02F) << i;
        EXPECT_NEAR(nearest_mm, gap_mm, 0.02F) << i;
    }
    EXPECT_GT(apart, 5000);
}

TEST(Hull, TouchesAreTheSameTheOtherWayRound) {
    RandomStream random(4, 0);
    for (int i = 0; i < 5000; ++i) {
        Hull const a = hull_at(any_shape(random, false), {}, random.uniform(-kPi, kPi));
        Vec2 const place_mm = random.uniform(0.0F, 150.0F) * direction(random.uniform(-kPi, kPi));
        Hull const b = hull_at(any_shape(random, false), place_mm, random.uniform(-kPi, kPi));
        Manifold const one = touches_of(a, b, 1000.0F);
        Manifold const other = touches_of(b, a, 1000.0F);
        if (length(one.normal + other.normal) < 1e-3F) {  // else both axes are as good
            EXPECT_EQ(one.count, other.count) << i;
        }
    }
}

TEST(Hull, HasTwoTouchesWhereSidesFaceEachOther) {
    Hull const box = hull_at(rectangle(40.0F, 20.0F), {}, 0.0F);
    Manifold const flat = touches_of(box, hull_at(rectangle(30.0F, 20.0F), {5.0F, 21.0F}, 0.0F), 5.0F);
    ASSERT_EQ(flat.count, 2U);
    EXPECT_EQ(flat.normal, (Vec2{0.0F, -1.0F}));
    for (ManifoldPoint const& touch : flat.touch) {
        EXPECT_FLOAT_EQ(touch.gap_mm, 1.0F);
        EXPECT_FLOAT_EQ(touch.point_mm.y, 10.5F);
    }
    EXPECT_FLOAT_EQ(std::min(flat.touch[0].point_mm.x, flat.touch[1].point_mm.x), -10.0F);
    EXPECT_FLOAT_EQ(std::max(flat.touch[0].point_mm.x, flat.touch[1].point_mm.x), 20.0F);
    EXPECT_EQ(touches_of(box, hull_at(rectangle(30.0F, 20.0F), {5.0F, 21.0F}, 0.0F), 0.5F).count, 0U);
    EXPECT_EQ(touches_of(box, hull_at(disk(10.0F), {0.0F, 21.0F}, 0.0F), 5.0F).count, 1U);
}

TEST(Hull, MassIsThatOfItsShape) {
    ShapeMass const box = mass_of(rectangle(30.0F, 40.0F));
    EXPECT_FLOAT_EQ(box.area_mm2, 1200.0F);
    EXPECT_FLOAT_EQ(box.gyration_mm2, (30.0F * 30.0F + 40.0F * 40.0F) / 12.0F);
    ShapeMass const wedge = mass_of(triangle(60.0F));
    EXPECT_NEAR(wedge.area_mm2, std::sqrt(3.0F) / 4.0F * 3600.0F, 0.01F);
    EXPECT_NEAR(wedge.gyration_mm2, 3600.0F / 12.0F, 0.01F);
}

/// Rows of disks, boxes and triangles, each of which fills this share of its area, in a box of about 700 mm.
World packed(float coverage, float restitution) {
    BodySpec const body{.friction = 0.1F, .restitution = restitution};
    constexpr float width_mm = 700.0F;
    World world = square_world(width_mm);
    float y_mm = 0.0F;
    float const scale = 1.0F / std::sqrt(coverage);
    float const box_mm = 40.0F;
    float const pitch_mm = scale * box_mm;
    auto const columns = static_cast<int>(width_mm / pitch_mm);
    float const lane_mm = width_mm / static_cast<float>(columns);
    for (int row = 0; row < 10; ++row) {
        for (int column = 0; column < columns; ++column) {
            float const x_mm = lane_mm * (static_cast<float>(column) + 0.5F);
            if (row % 2 == 0) {
                add_body(world, rectangle(box_mm, box_mm), {x_mm, y_mm + 0.5F * pitch_mm}, 0.0F, body);
            } else {
                // Two in a lane, each half as wide.
                float const half_mm = 0.5F * box_mm;
                add_body(world, rectangle(half_mm, box_mm), {x_mm - 0.25F * lane_mm, y_mm + 0.5F * pitch_mm}, 0.0F,
                         body);
                add_body(world, disk(0.5F * half_mm), {x_mm + 0.25F * lane_mm, y_mm + 0.25F * pitch_mm}, 0.0F, body);
                add_body(world, disk(0.5F * half_mm), {x_mm + 0.25F * lane_mm, y_mm + 0.75F * pitch_mm}, 0.0F, body);
            }
        }
        y_mm += pitch_mm;
    }
    float const side_mm = 60.0F;
    float const height_mm = std::sqrt(3.0F) / 2.0F * side_mm;
    for (int row = 0; row < 3; ++row) {
        for (int i = 0; (0.5F * static_cast<float>(i) + 1.0F) * scale * side_mm < width_mm; ++i) {
            bool const points_up = i % 2 == 0;
            float const centre_mm = (points_up ? 2.0F : 1.0F) / 3.0F * height_mm;
            float const x_mm = scale * side_mm * (0.5F * static_cast<float>(i) + 0.5F);
            add_body(world, triangle(side_mm), {x_mm, y_mm + 0.5F * (scale - 1.0F) * height_mm + centre_mm},
                     points_up ? 0.0F : kPi, body);
        }
        y_mm += scale * height_mm;
    }
    world.arena = make_arena({{{0, 0}, {width_mm, 0}, {width_mm, y_mm}, {0, y_mm}}});
    return world;
}

TEST_P(MovingHulls, DensePackingDoesNotOverlapNorGainEnergy) {
    for (float const restitution : {0.0F, 1.0F}) {
        World world = packed(0.8F, restitution);
        ASSERT_LT(deepest_overlap_mm(world), 1e-3F);
        RandomStream random(1, 0);
        for (Vec2& velocity : world.bodies.velocity_mm_s) {
            velocity = 60.0F * direction(random.uniform(-kPi, kPi));
        }
        auto const engine = make_engine(world, {.friction = 0.1F, .restitution = restitution});
        double const before = energy(world);
        auto const [highest, deepest_mm] = extremes_in(world, *engine, 250);
        EXPECT_LT(deepest_mm, is_ours() ? 0.5F : 2.5F) << restitution;
        EXPECT_LT(highest, (is_ours() ? 1.001 : 1.05) * before) << restitution;
    }
}

TEST_P(MovingHulls, PackingThatAllPushToOneSideStaysApart) {
    World world = packed(0.8F, 0.2F);
    auto const engine = make_engine(world, {});
    float const deepest_mm = deepest_when_all_push_mm(world, *engine, {50.0F, 20.0F}, 250);
    EXPECT_LT(deepest_mm, is_ours() ? 0.5F : 6.0F);
}

TEST_P(MovingHulls, RobotsPushARowOfBoxesToTheEndOfACorridor) {
    constexpr float length_mm = 1000.0F;
    constexpr float width_mm = 66.0F;
    World world = square_world();
    world.arena = make_arena({{{0, 0}, {length_mm, 0}, {length_mm, width_mm}, {0, width_mm}}});
    for (int i = 0; i < 5; ++i) {
        add_body(world, rectangle(80.0F, 60.0F), {400.0F + 90.0F * static_cast<float>(i), 0.5F * width_mm}, 0.0F);
    }
    for (float const y_mm : {16.0F, 50.0F}) {
        add_body(world, disk(15.0F), {300.0F, y_mm}, 0.0F);
    }
    auto const engine = make_engine(world, {});
    float deepest_mm = 0.0F;
    for (int step = 0; step < 2000; ++step) {
        for (std::size_t i = 5; i < 7; ++i) {
            world.robots.command[i] = {.velocity_mm_s = {60.0F, 0.0F}, .pending = step % 2 == 0};
        }
        engine->advance(world);
        deepest_mm = std::max(deepest_mm, deepest_overlap_mm(world));
    }
    EXPECT_LT(deepest_mm, is_ours() ? 0.5F : 4.0F);
    // Against the wall, one behind the other.
    for (int i = 0; i < 5; ++i) {
        float const behind_mm = 80.0F * (4.5F - static_cast<float>(i));
        EXPECT_NEAR(world.bodies.position_mm[static_cast<std::size_t>(i)].x, length_mm - behind_mm, 8.0F) << i;
    }
}

TEST_P(MovingHulls, BoxGoesThroughACorridor) {
    // An arena like an H on its side: a corridor 70 mm wide between two rooms.
    World world = square_world(1000.0F);
    world.arena = make_arena({{{0, 0},
                               {300, 0},
                               {300, 215},
                               {700, 215},
                               {700, 0},
                               {1000, 0},
                               {1000, 500},
                               {700, 500},
                               {700, 285},
                               {300, 285},
                               {300, 500},
                               {0, 500}}});
    std::uint32_t const box = add_body(world, rectangle(90.0F, 60.0F), {150.0F, 249.0F}, 0.0F, {.friction = 0.0F});
    auto const engine = make_engine(world, {.friction = 0.0F, .restitution = 0.0F});
    for (int step = 0; step < 1800; ++step) {
        world.robots.command[box] = {.velocity_mm_s = {50.0F, 1.0F}, .pending = step % 2 == 0};
        engine->advance(world);
        Vec2 const place_mm = world.bodies.position_mm[box];
        if (place_mm.x > 360.0F && place_mm.x < 640.0F) {
            EXPECT_GT(place_mm.y, 244.0F) << step;
            EXPECT_LT(place_mm.y, 256.0F) << step;
        }
    }
    EXPECT_GT(world.bodies.position_mm[box].x, 900.0F);
}

/// The pose of a bar that drops onto a point and slides along it, by the second.
std::vector<Vec2> poses_of_bar(World world) {
    std::uint32_t const bar =
        add_body(world, rectangle(300.0F, 20.0F), {470.0F, 480.0F}, 0.0F, {.friction = 0.0F, .restitution = 0.3F});
    world.bodies.velocity_mm_s[bar] = {60.0F, 40.0F};
    auto const engine =
        make_physics_engine("disk", world, {.friction = 0.0F, .restitution = 0.0F}, testing::one_worker());
    std::vector<Vec2> poses;
    for (int step = 0; step < 200; ++step) {
        engine->advance(world);
        if (step % 20 == 19) {
            poses.push_back(world.bodies.position_mm[bar]);
            poses.push_back({100.0F * world.bodies.heading_rad[bar], world.bodies.velocity_mm_s[bar].y});
        }
    }
    return poses;
}

/// Not the edges beside it, which have other directions.
TEST(MovingHull, IsPushedByTheCornerOfAWallAsByAPin) {
    World cornered = square_world(1000.0F);
    cornered.arena =
        make_arena({{{0, 0}, {1000, 0}, {1000, 1000}, {0, 1000}}, {{500, 500}, {530, 560}, {500, 600}, {470, 560}}});
    World pinned = square_world(1000.0F);
    add_body(pinned, disk(0.05F), {500.0F, 500.05F}, 0.0F, {.friction = 0.0F, .restitution = 0.0F, .fixed = true});
    std::vector<Vec2> const by_corner = poses_of_bar(cornered);
    std::vector<Vec2> const by_pin = poses_of_bar(pinned);
    EXPECT_LT(by_pin.back().y, 0.0F);  // it bounced
    for (std::size_t i = 0; i < by_pin.size(); ++i) {
        EXPECT_NEAR(by_corner[i].x, by_pin[i].x, 0.2F) << i;
        EXPECT_NEAR(by_corner[i].y, by_pin[i].y, 0.2F) << i;
    }
}

/// Whatever the speed, and however thin.
TEST_P(MovingHulls, NothingPassesThroughAThinBar) {
    for (float const thickness_mm : {2.0F, 10.0F}) {
        for (float const speed_mm_s : {100.0F, 1000.0F, 5000.0F, 15000.0F}) {
            if (!is_ours() && speed_mm_s * 0.01F > thickness_mm) {
                continue;  // Box2D puts what jumps a bar on its other side
            }
            for (Shape const& shape : {disk(10.0F), rectangle(30.0F, 12.0F), triangle(25.0F)}) {
                World world = square_world(2000.0F);
                std::uint32_t const bar =
                    add_body(world, rectangle(thickness_mm, 1980.0F), {1000.0F, 1000.0F}, 0.0F, {.density = 1e5F});
                std::uint32_t const shot = add_body(world, shape, {500.0F, 977.0F}, 0.3F);
                world.bodies.velocity_mm_s[shot] = {speed_mm_s, 0.0F};
                auto const engine = make_engine(world, {});
                for (int step = 0; step < 600; ++step) {
                    engine->advance(world);
                    ASSERT_LT(world.bodies.position_mm[shot].x, world.bodies.position_mm[bar].x)
                        << thickness_mm << " mm, " << speed_mm_s << " mm/s, step " << step;
                }
                EXPECT_LT(world.bodies.velocity_mm_s[shot].x, speed_mm_s);
            }
        }
    }
}

TEST_P(MovingHulls, SpinningBarStrikesADisk) {
    for (float const spin_rad_s : {2.0F, 20.0F, 100.0F}) {
        World world = square_world(2000.0F);
        std::uint32_t const bar =
            add_body(world, rectangle(400.0F, 10.0F), {1000.0F, 1000.0F}, 0.0F, {.density = 1e4F});
        std::uint32_t const ball = add_body(world, disk(10.0F), {1150.0F, 1060.0F}, 0.0F);
        world.bodies.angular_velocity_rad_s[bar] = spin_rad_s;
        auto const engine = make_engine(world, {});
        for (int step = 0; step < 200 && world.bodies.velocity_mm_s[ball] == Vec2{}; ++step) {
            engine->advance(world);
        }
        EXPECT_GT(length(world.bodies.velocity_mm_s[ball]), 100.0F * spin_rad_s) << spin_rad_s;
        EXPECT_GT(world.bodies.velocity_mm_s[ball].y, 0.0F) << spin_rad_s;
    }
}

TEST_P(MovingHulls, TurnOnTheirOwn) {
    World world = square_world(1000.0F);
    std::uint32_t const box = add_body(world, rectangle(80.0F, 40.0F), {300.0F, 500.0F}, 0.5F);
    world.bodies.velocity_mm_s[box] = {30.0F, -10.0F};
    world.bodies.angular_velocity_rad_s[box] = 0.7F;
    auto const engine = make_engine(world, {});
    for (int step = 0; step < 300; ++step) {
        engine->advance(world);
    }
    EXPECT_NEAR(world.bodies.position_mm[box].x, 390.0F, 0.05F);
    EXPECT_NEAR(world.bodies.position_mm[box].y, 470.0F, 0.05F);
    EXPECT_NEAR(world.bodies.heading_rad[box], 2.6F, 0.001F);
}

/// A disk hits a bar off its middle: the same everywhere in a periodic world.
TEST(MovingHull, TouchesAcrossTheSeam) {
    std::vector<Vec2> velocities_mm_s;
    std::vector<float> spins_rad_s;
    for (float const x_mm : {500.0F, 990.0F, 1005.0F}) {
        World world = square_world(1000.0F);
        world.periodic = true;
        std::uint32_t const bar = add_body(world, rectangle(40.0F, 160.0F), {std::fmod(x_mm, 1000.0F), 30.0F}, 0.0F);
        std::uint32_t const ball = add_body(world, disk(26.5F), {x_mm - 100.0F, 990.0F}, 0.0F);
        world.bodies.velocity_mm_s[ball] = {100.0F, 0.0F};
        auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
        for (int step = 0; step < 100; ++step) {
            engine->advance(world);
        }
        velocities_mm_s.push_back(world.bodies.velocity_mm_s[bar]);
        spins_rad_s.push_back(world.bodies.angular_velocity_rad_s[bar]);
    }
    EXPECT_GT(velocities_mm_s[0].x, 10.0F);
    EXPECT_GT(std::abs(spins_rad_s[0]), 0.1F);
    for (std::size_t i = 1; i < velocities_mm_s.size(); ++i) {
        EXPECT_NEAR(velocities_mm_s[i].x, velocities_mm_s[0].x, 0.1F);
        EXPECT_NEAR(velocities_mm_s[i].y, velocities_mm_s[0].y, 0.1F);
        EXPECT_NEAR(spins_rad_s[i], spins_rad_s[0], 0.01F);
    }
}

TEST_P(MovingHulls, WedgeComesToRestInAnAcuteCorner) {
    // A corner of 30 degrees, into which a triangle is pushed.
    World world = square_world(1000.0F);
    world.arena = make_arena({{{0, 500}, {866, 0}, {866, 1000}}});
    std::uint32_t const wedge = add_body(world, triangle(60.0F), {600.0F, 500.0F}, 0.2F, {.restitution = 0.0F});
    auto const engine = make_engine(world, {.restitution = 0.0F});
    for (int step = 0; step < 1500; ++step) {
        world.robots.command[wedge] = {.velocity_mm_s = {-60.0F, 0.0F}, .pending = step % 2 == 0};
        engine->advance(world);
        Hull const hull =
            hull_at(world.bodies.shape[wedge], world.bodies.position_mm[wedge], world.bodies.heading_rad[wedge]);
        for (std::uint32_t k = 0; k < hull.count; ++k) {
            Vec2 const corner_mm = hull.corner_mm[k];
            float const above_mm = std::abs(corner_mm.y - 500.0F) * 866.0F / 1000.0F - 0.5F * corner_mm.x;
            ASSERT_LT(above_mm, is_ours() ? 0.6F : 2.0F) << step;
        }
    }
}

POGOSIM_FOR_EACH_ENGINE(MovingHulls);

}  // namespace
}  // namespace pogosim
