// Receivers that are kept while nothing changes are those that a fresh search finds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "base/random.hpp"
#include "comms/visibility.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kSide = 1500.0F;

struct Reached {
    std::uint32_t robot;
    Vec2 from_emitter_mm;
    std::uint8_t faces;
    std::uint8_t emitters;

    friend bool operator==(Reached const&, Reached const&) = default;
};

std::vector<Reached> reached(Visibility& visibility, World const& world, std::uint32_t robot, std::uint8_t emitters,
                             float range_mm) {
    std::vector<Reached> result;
    for (Receiver const& receiver : visibility.receivers(world, robot, emitters, range_mm)) {
        result.push_back({receiver.robot, receiver.from_emitter_mm, visibility.faces_of(world, receiver, range_mm),
                          receiver.emitters});
    }
    return result;
}

/// The answers of the cache of a long run, and those of a new one.
void expect_same_answers(Visibility& known, World const& world, RandomStream& random) {
    Visibility fresh;
    fresh.update(world);
    known.update(world);
    for (std::uint32_t robot = 0; robot < world.robots.size(); ++robot) {
        std::uint8_t const emitters =
            random.below(4) != 0 ? kAllFaces : static_cast<std::uint8_t>(1 + random.below(15));
        float const range_mm = random.below(8) != 0 ? 80.0F : 50.0F;
        ASSERT_EQ(reached(known, world, robot, emitters, range_mm), reached(fresh, world, robot, emitters, range_mm))
            << "robot " << robot << ", emitters " << int{emitters};
    }
}

World world_of(std::uint32_t robots, bool periodic, RandomStream& random) {
    World world = testing::square_world(kSide);
    world.periodic = periodic;
    for (std::uint32_t i = 0; i < robots; ++i) {
        testing::add_robot(world, {random.uniform(0, kSide), random.uniform(0, kSide)}, random.uniform(-kPi, kPi));
        world.bodies.radius_mm[i] = random.uniform(15.0F, 30.0F);
    }
    return world;
}

void switch_one(World& world, RandomStream& random) {
    std::uint32_t const robot = random.below(static_cast<std::uint32_t>(world.robots.size()));
    auto const place = std::ranges::lower_bound(world.switched_off, robot);
    if (place != world.switched_off.end() && *place == robot) {
        world.switched_off.erase(place);
    } else {
        world.switched_off.insert(place, robot);
    }
}

enum class Event { rest, step, turn, set_elsewhere, switched };

void happen(Event event, World& world, RandomStream& random) {
    std::uint32_t const body = random.below(static_cast<std::uint32_t>(world.robots.size()));
    Vec2 const place = world.bodies.position_mm[body];
    float const heading_rad = world.bodies.heading_rad[body];
    switch (event) {
        case Event::rest:
            break;
        case Event::step:
            set_pose(world.bodies, body, place + Vec2{random.uniform(-2, 2), random.uniform(-2, 2)}, heading_rad);
            break;
        case Event::turn:
            set_pose(world.bodies, body, place, heading_rad + random.uniform(-1, 1));
            break;
        case Event::set_elsewhere:
            set_pose(world.bodies, body, {random.uniform(0, kSide), random.uniform(0, kSide)}, heading_rad);
            break;
        case Event::switched:
            switch_one(world, random);
            break;
    }
}

TEST(KeptReceivers, AreThoseOfAFreshSearchWhateverHappens) {
    for (bool const periodic : {false, true}) {
        RandomStream random(11, periodic ? 1 : 0);
        World world = world_of(150, periodic, random);
        Visibility known;
        for (Event const event : {Event::step, Event::turn, Event::set_elsewhere, Event::switched}) {
            for (int step = 0; step < 60; ++step) {
                happen(step % 3 == 0 ? event : Event::rest, world, random);
                expect_same_answers(known, world, random);
                ASSERT_FALSE(HasFatalFailure()) << "step " << step << " of event " << static_cast<int>(event);
            }
        }
        // All at once, and several times between two looks.
        for (int step = 0; step < 40; ++step) {
            for (std::uint32_t k = random.below(4) * 100; k > 0; --k) {
                happen(static_cast<Event>(random.below(5)), world, random);
            }
            expect_same_answers(known, world, random);
            ASSERT_FALSE(HasFatalFailure()) << "step " << step;
        }
    }
}

TEST(KeptReceivers, KnowOfWallsAndOfMembranesThatMove) {
    RandomStream random(5, 5);
    World world = world_of(80, false, random);
    testing::add_wall(world, {{{0, 0}, {kSide, 0}, {kSide, kSide}, {0, kSide}}});
    testing::add_membrane(world, {{600, 600}, {800, 600}, {800, 800}, {600, 800}});
    Visibility known;
    std::size_t const dot = world.bodies.position_mm.size() - 2;
    for (int step = 0; step < 60; ++step) {
        if (step % 4 == 0) {
            world.bodies.position_mm[dot].x += 20.0F;
        }
        if (step % 5 == 0) {
            world.switched_off = step % 2 == 0 ? std::vector<std::uint32_t>{80} : std::vector<std::uint32_t>{};
        }
        expect_same_answers(known, world, random);
        ASSERT_FALSE(HasFatalFailure()) << "step " << step;
    }
}

TEST(KeptReceivers, KnowOfBlockersThatMove) {
    for (bool const periodic : {false, true}) {
        RandomStream random(6, periodic ? 1 : 0);
        World world = world_of(150, periodic, random);
        ObjectSpec spec;
        spec.body = BodySpec{.blocks_infrared = true};
        for (int i = 0; i < 60; ++i) {
            bool const is_disk = i % 2 == 0;
            spec.shape = {.kind = is_disk ? ShapeKind::disk : ShapeKind::rectangle,
                          .radius_mm = random.uniform(5, 40),
                          .width_mm = random.uniform(5, 200),
                          .height_mm = random.uniform(2, 20)};
            testing::add_body(world, {random.uniform(0, kSide), random.uniform(0, kSide)}, random.uniform(-kPi, kPi),
                              spec);
        }
        Visibility known;
        for (int step = 0; step < 200; ++step) {
            // Robots move rarely.
            std::uint32_t const body = random.below(8) == 0 ? random.below(150) : 150 + random.below(60);
            if (step % 3 == 0) {
                Vec2 const place = step % 2 == 0 ? world.bodies.position_mm[body] + Vec2{random.uniform(-9, 9), 3.0F}
                                                 : Vec2{random.uniform(0, kSide), random.uniform(0, kSide)};
                set_pose(world.bodies, body, place, random.uniform(-kPi, kPi));
            }
            expect_same_answers(known, world, random);
            ASSERT_FALSE(HasFatalFailure()) << "step " << step << ", periodic " << periodic;
        }
    }
}

/// Lists that grow leave holes in the cache's memory, until it gives up all; and some lists are too long for it.
TEST(ReceiverCache, HasNothingOrWhatWasKeptHoweverMuchItForgets) {
    constexpr std::uint32_t kRobots = 10;
    ReceiverCache cache;
    cache.clear(kRobots);
    std::vector<std::uint32_t> counts(kRobots, 0);
    RandomStream random(3, 0);
    int forgotten = 0;
    int refused = 0;
    for (int round = 0; round < 300; ++round) {
        std::uint32_t const robot = random.below(kRobots);
        std::uint32_t const count = random.below(round < 200 ? 40'000U : 400'000U);
        cache.store(robot, kAllFaces, 80.0F, 7, std::vector<Receiver>(count, {.robot = robot, .from_emitter_mm = {}}));
        counts[robot] = count;
        refused += cache.find(robot, kAllFaces, 80.0F) == nullptr ? 1 : 0;
        for (std::uint32_t k = 0; k < kRobots; ++k) {
            ReceiverCache::List const* const list = cache.find(k, kAllFaces, 80.0F);
            if (list == nullptr) {
                forgotten += k != robot && counts[k] > 0 ? 1 : 0;
                continue;
            }
            std::span const receivers = cache.receivers(*list);
            ASSERT_EQ(receivers.size(), counts[k]);
            ASSERT_TRUE(std::ranges::all_of(receivers, [&](Receiver const& one) { return one.robot == k; }));
        }
    }
    EXPECT_GT(forgotten, 0);
    EXPECT_GT(refused, 0);
    EXPECT_LT(refused, 150);
}

}  // namespace
}  // namespace pogosim
