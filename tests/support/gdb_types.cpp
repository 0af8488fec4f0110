// Values of the types that tools/gdb/pogosim_gdb.py prints, for tests/python/test_gdb.py.
#include "robot/controller.hpp"
#include "world/world.hpp"

namespace {

void stop_here(pogosim::World const&, pogosim::Controller const&, pogosim::Leds const&) {}

}  // namespace

/// What is linked into every program asks for it.
int robot_main() {
    return 0;
}

int main() {
    pogosim::World world;
    world.step = 250;
    world.robots.id = {0, 1, 2};
    world.robots.category = {0, 0, 0};
    world.robots.body = {0, 1, 2};
    world.robots.led.resize(3);
    world.robots.command.resize(3);
    world.robots.stream.resize(3);
    world.bodies.position_mm = {{12.5F, -3.0F}, {100.0F, 0.0F}};
    world.objects.resize(4);
    std::array<int, 3> const queue_sizes{20, 20, 1};
    world.mailboxes = pogosim::Mailboxes(queue_sizes, 8);
    world.mailboxes.push(0, {}, {});
    for (int i = 0; i < 30; ++i) {
        world.mailboxes.push(1, {.payload_length = 8}, std::array<std::byte, 8>{});
    }
    world.mailboxes.push(2, {}, {});
    world.mailboxes.push(2, {}, {});

    pogosim::Controller controller;
    controller.calls = 156;
    world.devices.clock_us = {0, 2'500'000};
    pogosim::Leds const leds{{{255, 128, 0}, {}, {}, {}, {0, 0, 25}}};
    stop_here(world, controller, leds);
    return 0;
}
