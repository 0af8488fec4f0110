// A world is a value: copied in the middle of a run, it develops as the original does.
#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "base/worker_pool.hpp"
#include "comms/ir_channel.hpp"
#include "device/clock.hpp"
#include "device/infrared.hpp"
#include "device/leds.hpp"
#include "device/motors.hpp"
#include "device/sensing.hpp"
#include "device/sensors.hpp"
#include "device/switched_off.hpp"
#include "physics/physics_engine.hpp"
#include "support/devices.hpp"

namespace pogosim {
namespace {

constexpr std::uint32_t kRobots = 40;
constexpr int kSide = 7;

World swarm() {
    ObjectSpec spec = testing::pogobot_spec();
    spec.robot->linear_noise_stddev = 0.1F;
    spec.robot->clock_drift_stddev_us = 50.0F;
    spec.robot->motor_bias = {.min = -50, .max = 50};
    spec.robot->sensors = kRobotSensors;
    spec.robot->ir.queue_size = 4;
    spec.robot->ir.reception = {.law = ReceptionLaw::constant, .rate = 0.8};
    World world = testing::square_world(600.0F);
    for (std::uint32_t i = 0; i < kRobots; ++i) {
        Vec2 const place{50.0F + 75.0F * static_cast<float>(i % kSide), 50.0F + 75.0F * static_cast<float>(i / kSide)};
        testing::add_robot(world, place, static_cast<float>(i), spec);
    }
    set_up_devices(world, 3);
    world.devices.flash[5].slot = {1};
    world.devices.flash[5].pages.emplace_back();
    set_alive(world, 7, false);
    return world;
}

/// What a program might do: tumble, look, send and receive.
void tick(World& world, std::uint32_t robot) {
    measure_at_tick(world, robot);
    std::int64_t const began_us = world.devices.clock_us[robot];
    RandomStream& random = world.robots.stream[robot];
    set_motor_power(world, robot, 0, static_cast<std::uint16_t>(random.below(1024)));
    set_motor_power(world, robot, 1, static_cast<std::uint16_t>(random.below(1024)));
    ImuReading const reading = read_imu(world, robot);
    set_led(world, robot, 0, {static_cast<std::uint8_t>(static_cast<int>(10.0F * reading.acceleration[0])), 0, 0});
    std::array<std::byte, 200> payload{};
    payload[0] = static_cast<std::byte>(random.bits());
    transmit(world, robot, world.air, short_packet(world, robot, kAllFaces, payload),
             watched_send_probability(world, robot));
    if (random.below(3) == 0) {
        if (auto const message = receive(world, robot)) {
            auto const red = static_cast<std::uint8_t>(message->payload[0]);
            set_led(world, robot, 1, {red, message->header.receiver_ir_index, 0});
        }
    }
    world.devices.clock_us[robot] += 16'000;
    drift_clock(world, robot, began_us);
    drive(world, robot);
}

/// The stages of a step.
class Stages {
public:
    explicit Stages(World const& world) : engine_(make_disk_engine(world, {}, workers_)) {}

    void run(World& world, int steps) {
        for (int step = 0; step < steps; ++step) {
            hold_switched_off(world);
            for (std::uint32_t robot = 0; robot < kRobots; ++robot) {
                if (time_us(world) >= world.devices.clock_us[robot]) {
                    tick(world, robot);
                }
            }
            channel_.deliver(world);
            engine_->advance(world);
            ++world.step;
        }
    }

private:
    WorkerPool workers_;
    IrChannel channel_;
    std::unique_ptr<PhysicsEngine> engine_;
};

TEST(World, CopiedInTheMiddleOfARunDevelopsAsTheOriginal) {
    World world = swarm();
    Stages(world).run(world, 150);
    World copy = world;
    EXPECT_TRUE(copy == world);
    ASSERT_GT(world.mailboxes.dropped(0), 0U);
    // The order in which an engine finds contacts depends on the age of its neighbour list: both begin with a new one.
    Stages of_copy(copy);
    Stages of_world(world);
    of_world.run(world, 1);
    EXPECT_FALSE(copy == world);
    of_copy.run(copy, 1);
    EXPECT_TRUE(copy == world);
    of_world.run(world, 150);
    of_copy.run(copy, 150);
    EXPECT_TRUE(copy == world);
}

TEST(World, CopyHasMessagesOfItsOwn) {
    World world = swarm();
    Stages(world).run(world, 50);
    World copy;
    copy = world;
    ASSERT_FALSE(world.mailboxes.empty(0));
    while (receive(world, 0)) {
    }
    EXPECT_FALSE(copy.mailboxes.empty(0));
    EXPECT_FALSE(copy == world);
    EXPECT_TRUE(World(copy) == copy);
}

}  // namespace
}  // namespace pogosim
