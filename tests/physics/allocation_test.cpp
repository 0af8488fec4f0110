// Moving a swarm takes no memory from the system once its lists have grown: allocations cost as much as contacts.
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "base/worker_pool.hpp"
#include "physics/physics_engine.hpp"
#include "support/small_world.hpp"

namespace {

std::atomic<std::size_t> allocations = 0;  // since the start of this program

void* allocate(std::size_t size) {
    ++allocations;
    return std::malloc(size > 0 ? size : 1);
}

}  // namespace

// The forms for arrays call these. Those that do not throw call them, too, but not in builds with a sanitizer.
void* operator new(std::size_t size) {
    if (void* const memory = allocate(size)) {
        return memory;
    }
    throw std::bad_alloc();
}
void* operator new(std::size_t size, std::nothrow_t const& /*tag*/) noexcept {
    return allocate(size);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::nothrow_t const& /*tag*/) noexcept {
    std::free(memory);
}

namespace pogosim {
namespace {

/// Robots on a square lattice, each on 100 mm x 100 mm.
World lattice(std::uint32_t columns) {
    World world = testing::square_world(100.0F * static_cast<float>(columns));
    ObjectSpec spec = testing::pogobot_spec();
    for (std::uint32_t i = 0; i < columns * columns; ++i) {
        Vec2 const place_mm{100.0F * (static_cast<float>(i % columns) + 0.5F),
                            100.0F * (static_cast<float>(i / columns) + 0.5F)};
        testing::add_robot(world, place_mm, 0.0F, spec);
    }
    return world;
}

void wander(World& world) {
    for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
        world.robots.command[i] = {.velocity_mm_s = 90.0F * world.bodies.heading_dir[i],
                                   .angular_velocity_rad_s = world.robots.stream[i].normal(),
                                   .pending = true};
    }
}

TEST(Allocations, MovingASwarmMakesNoneInMostSteps) {
    World world = lattice(15);
    WorkerPool workers;
    auto const engine = make_physics_engine("disk", world, {}, workers);
    auto const move = [&](int steps) {
        for (int step = 0; step < steps; ++step) {
            wander(world);
            engine->advance(world);
        }
    };
    move(1000);
    std::size_t const before = allocations;
    move(1000);
    EXPECT_LT(allocations - before, 100U);  // lists that were never so long: far fewer than steps
}

}  // namespace
}  // namespace pogosim
