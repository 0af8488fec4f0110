// Messages that several workers deliver: what becomes of each is the same as with one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/random.hpp"
#include "base/worker_pool.hpp"
#include "comms/ir_channel.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

struct Swarm {
    bool is_periodic = false;
    bool moves = false;
    bool has_outlines = false;
    bool has_blockers = false;
    float range_mm = 80.0F;
};

/// What became of all messages.
struct Outcome {
    std::vector<std::byte> waiting;
    std::vector<std::uint64_t> dropped;
    std::vector<float> next_draws;
    std::uint64_t attempts = 0;
    std::uint64_t receptions = 0;

    friend bool operator==(Outcome const&, Outcome const&) = default;
};

World make_world(Swarm const& swarm) {
    constexpr float kSideMm = 2500.0F;
    RandomStream random(9, 0);
    World world = testing::square_world(kSideMm);
    world.periodic = swarm.is_periodic;
    ObjectSpec spec = testing::pogobot_spec();
    spec.robot->ir.queue_size = 5;  // some are full
    for (std::uint32_t i = 0; i < 800; ++i) {
        testing::add_robot(world, {random.uniform(30.0F, kSideMm - 30.0F), random.uniform(30.0F, kSideMm - 30.0F)},
                           random.uniform(0.0F, 6.0F), spec);
    }
    if (swarm.has_outlines) {
        testing::add_wall(world, world.arena.polygons);
    }
    if (swarm.has_blockers) {
        ObjectSpec pillar;
        pillar.shape.radius_mm = 15.0F;
        pillar.body = BodySpec{.blocks_infrared = true};
        for (int i = 0; i < 400; ++i) {
            testing::add_body(world, {random.uniform(0.0F, kSideMm), random.uniform(0.0F, kSideMm)}, 0.0F, pillar);
        }
    }
    return world;
}

void send(World& world, std::uint32_t robot, float range_mm) {
    std::array<std::byte, 6> const payload{std::byte(robot), std::byte(world.step)};
    std::uint8_t const emitters = robot % 3 == 0 ? std::uint8_t{4} : kAllFaces;
    testing::send(world, robot, payload, {.emitters = emitters, .send_probability = 0.4F, .range_mm = range_mm});
}

Outcome outcome_of(World& world, IrChannel const& channel) {
    Outcome outcome{.waiting = {},
                    .dropped = {},
                    .next_draws = {},
                    .attempts = channel.attempts(),
                    .receptions = channel.receptions()};
    for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
        for (std::span<std::byte const> const messages : world.mailboxes.waiting(i)) {
            outcome.waiting.insert(outcome.waiting.end(), messages.begin(), messages.end());
        }
        outcome.dropped.push_back(world.mailboxes.dropped(i));
        outcome.next_draws.push_back(world.robots.stream[i].uniform());
    }
    return outcome;
}

Outcome delivered_by(std::uint32_t threads, Swarm const& swarm) {
    World world = make_world(swarm);
    WorkerPool workers(threads);
    IrChannel channel;
    RandomStream random(10, 0);
    for (world.step = 0; world.step < 30; ++world.step) {
        for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
            if (swarm.moves && world.robots.body[i] != kNone) {
                world.bodies.position_mm[i] =
                    wrapped(world, world.bodies.position_mm[i] + Vec2{random.normal(), random.normal()});
            }
            // Up to three each, so that parts end among those of one robot.
            for (std::uint32_t k = random.below(4); k > 0; --k) {
                send(world, i, swarm.range_mm);
            }
        }
        channel.deliver(world, nullptr, &workers);
        if (world.step % 10 == 9) {
            for (std::uint32_t i = 0; i < world.robots.size(); i += 2) {
                world.mailboxes.clear(i);
            }
        }
    }
    return outcome_of(world, channel);
}

Transmission transmission_of(std::uint32_t robot) {
    Transmission transmission;
    transmission.robot = robot;
    return transmission;
}

TEST(SharedDelivery, EachRobotsTransmissionsAreInOnePart) {
    // Robots with many transmissions, with few, and one with nearly all of them.
    for (std::vector<std::uint32_t> const& counts :
         {std::vector<std::uint32_t>{1, 1, 1, 1, 1, 1, 1, 1}, std::vector<std::uint32_t>{7, 2, 9, 1, 1, 30, 3},
          std::vector<std::uint32_t>{1, 200, 1}, std::vector<std::uint32_t>{50}}) {
        std::vector<Transmission> transmissions;
        for (std::uint32_t robot = 0; robot < counts.size(); ++robot) {
            transmissions.insert(transmissions.end(), counts[robot], transmission_of(robot));
        }
        for (std::size_t const parts : {1U, 2U, 3U, 8U}) {
            std::vector<std::uint32_t> ends(parts);
            split_by_sender(transmissions, ends);
            EXPECT_EQ(ends.back(), transmissions.size());
            EXPECT_TRUE(std::ranges::is_sorted(ends));
            for (std::uint32_t const end : ends) {
                EXPECT_TRUE(end == transmissions.size() || transmissions[end - 1].robot != transmissions[end].robot);
            }
        }
    }
}

TEST(SharedDelivery, PartsHaveAboutTheSameSize) {
    std::vector<Transmission> transmissions;
    for (std::uint32_t robot = 0; robot < 1000; ++robot) {
        transmissions.insert(transmissions.end(), robot % 3, transmission_of(robot));
    }
    std::array<std::uint32_t, 4> ends{};
    split_by_sender(transmissions, ends);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        EXPECT_NEAR(ends[i], static_cast<double>(transmissions.size() * (i + 1)) / 4.0, 2.0);
    }
}

TEST(SharedDelivery, GivesAllRobotsTheSameMessagesWithAnyNumberOfWorkers) {
    for (Swarm const& swarm :
         {Swarm{}, Swarm{.moves = true}, Swarm{.is_periodic = true, .moves = true},
          Swarm{.moves = true, .has_outlines = true}, Swarm{.moves = true, .has_outlines = true, .has_blockers = true},
          Swarm{.range_mm = 900.0F}}) {
        Outcome const expected = delivered_by(1, swarm);
        ASSERT_GT(expected.receptions, 1000U);
        EXPECT_GT(std::ranges::max(expected.dropped), 0U);
        for (std::uint32_t const threads : {2U, 3U, 8U}) {
            EXPECT_EQ(delivered_by(threads, swarm), expected) << threads << " threads, moves: " << swarm.moves;
        }
    }
}

TEST(SharedDelivery, KeepsTheOrderOfTransmissionsThatAreNotInTheOrderOfRobots) {
    auto const deliver = [](std::uint32_t threads) {
        World world = make_world({});
        WorkerPool workers(threads);
        IrChannel channel;
        for (world.step = 0; world.step < 30; ++world.step) {
            // Several ticks in a step: workers that shared them would draw from the same robots' streams at a time.
            for (int tick = 0; tick < 16; ++tick) {
                for (std::uint32_t i = 0; i < 100; ++i) {
                    send(world, i, 80.0F);
                }
            }
            channel.deliver(world, nullptr, &workers);
        }
        return outcome_of(world, channel);
    };
    Outcome const expected = deliver(1);
    for (int attempt = 0; attempt < 5; ++attempt) {
        EXPECT_EQ(deliver(8), expected);
    }
}

}  // namespace
}  // namespace pogosim
