#include "sim/state_hash.hpp"

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "base/fnv_1a.hpp"
#include "device/flash.hpp"
#include "process/address_space.hpp"
#include "robot/robot_memory.hpp"

namespace pogosim {

namespace {

class Hash {
public:
    void add(std::integral auto value) { add_word(static_cast<std::uint64_t>(value)); }
    void add(float value) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof(bits));
        add_word(bits);
    }
    void add(Vec2 value) {
        add(value.x);
        add(value.y);
    }
    void add(RandomStream stream) {
        add(stream.bits());  // of a copy: the numbers that would come
        add(stream.bits());
    }
    /// Hashes the elements, but not their number.
    void add_bytes(std::span<std::byte const> bytes) {
        for (std::byte const byte : bytes) {
            add(std::to_integer<std::uint8_t>(byte));
        }
    }
    template <class T>
    void add_all(std::vector<T> const& values) {
        for (T const& value : values) {
            add(value);
        }
    }

    std::uint64_t value() const { return value_; }

private:
    void add_word(std::uint64_t word) { value_ = (value_ ^ word) * kFnvPrime; }

    std::uint64_t value_ = kFnvBasis;
};

void add_leds(Hash& hash, Leds const& leds) {
    for (Rgb const colour : leds) {
        hash.add((colour.r << 16) | (colour.g << 8) | colour.b);
    }
}

void add_world(Hash& hash, World const& world) {
    hash.add(world.step);
    Bodies const& bodies = world.bodies;
    hash.add_all(bodies.position_mm);
    hash.add_all(bodies.heading_rad);
    hash.add_all(bodies.velocity_mm_s);
    hash.add_all(bodies.angular_velocity_rad_s);
    for (Leds const& leds : world.robots.led) {
        add_leds(hash, leds);
    }
    hash.add_all(world.robots.stream);
    hash.add_all(world.light.level);
    hash.add(world.air.transmissions.size());
    hash.add(world.air.payloads.size());
    hash.add_bytes(world.air.payloads);
}

void add_robot(Hash& hash, Controller const& controller, World const& world, std::size_t robot) {
    Devices const& devices = world.devices;
    Mailboxes const& mailboxes = world.mailboxes;
    hash.add(devices.clock_us[robot]);
    LoopGlobals const& loop = controller.loop;
    hash.add(devices.ticks[robot]);
    hash.add(loop.loop_hz);
    hash.add(loop.max_messages_per_tick);
    hash.add(loop.send_percent);
    hash.add(loop.error_led);
    hash.add(loop.sent);
    hash.add(loop.received);
    hash.add(loop.milliseconds);
    for (std::size_t motor = 0; motor < kMotorCount; ++motor) {
        hash.add(devices.motors[robot].power[motor]);
        hash.add(devices.motors[robot].direction[motor]);
    }
    hash.add(devices.ir_power[robot]);
    hash.add(devices.messages_sent[robot]);
    hash.add(devices.messages_received[robot]);
    hash.add(controller.random);
    hash.add(controller.seeds.later);
    if (controller.times != nullptr) {
        hash.add(controller.rest_us);
    }
    hash.add(mailboxes.size(robot));
    for (std::span<std::byte const> const messages : mailboxes.waiting(robot)) {
        hash.add_bytes(messages);
    }
    hash.add(mailboxes.dropped(robot));
}

void add_flash(Hash& hash, Flash const& flash, std::size_t robot) {
    for (std::uint16_t const page : written_pages(flash)) {
        hash.add(robot);
        hash.add(page);
        hash.add_bytes(page_at(flash, page));
    }
}

void add_magnetometer(Hash& hash, Magnetometer const& magnetometer, std::size_t robot) {
    if (magnetometer.samples > 0) {
        hash.add(robot);
        hash.add(magnetometer.samples);
        hash.add(magnetometer.taken);
        for (std::int16_t const count : magnetometer.last) {
            hash.add(count);
        }
    }
}

/// Hashes what robots have changed in their own memory. Addresses differ from run to run: for an address in the
/// program, its offset counts; for any other, only that it is an address.
void add_own_memory(Hash& hash, Controllers const& controllers) {
    AddressSpace const addresses(controllers.image());
    auto const add_part = [&](RobotMemory::Part const& part) {
        hash.add(part.offset);
        std::span<std::byte const> rest = part.bytes;
        for (; rest.size() >= sizeof(std::uint64_t); rest = rest.subspan(sizeof(std::uint64_t))) {
            std::uint64_t word = 0;
            std::memcpy(&word, rest.data(), sizeof(word));
            hash.add(addresses.without_place(word));
        }
        hash.add_bytes(rest);
    };
    for (std::uint32_t robot = 0; robot < controllers.all().size(); ++robot) {
        std::ranges::for_each(controllers.own_memory()->changed_parts(robot), add_part);
    }
    std::ranges::for_each(controllers.own_memory()->changed_parts(kNone), add_part);
}

/// What is left in an emptying battery, and the noise that an inertial unit would have next.
void add_chips(Hash& hash, World const& world, std::size_t robot) {
    RobotSpec const& spec = world.spec_of(robot);
    if (spec.battery) {
        hash.add(static_cast<float>(world.devices.battery[robot].used_mas));
    }
    if (spec.sensors.acceleration_noise_m_s2 > 0.0F || spec.sensors.angular_noise_rad_s > 0.0F) {
        hash.add(world.devices.imu_noise[robot]);
    }
}

}  // namespace

std::uint64_t state_hash(World const& world, Controllers const& controllers,
                         std::span<std::unique_ptr<Brain> const> brains) {
    Hash hash;
    add_world(hash, world);
    auto const all = controllers.all();
    for (std::size_t robot = 0; robot < all.size(); ++robot) {
        add_robot(hash, all[robot], world, robot);
    }
    // Adds nothing where none of these has changed.
    for (std::size_t robot = 0; robot < all.size(); ++robot) {
        add_magnetometer(hash, world.devices.magnetometer[robot], robot);
        add_flash(hash, world.devices.flash[robot], robot);
    }
    for (std::size_t robot = 0; robot < all.size(); ++robot) {
        add_chips(hash, world, robot);
    }
    for (SwitchedOff const& off : world.when_switched_on) {
        hash.add(off.robot);
        hash.add(off.clock_us);
        add_leds(hash, off.leds);
    }
    for (std::size_t robot = 0; robot < all.size(); ++robot) {
        if (world.devices.infrared[robot].is_muted != 0 || world.mailboxes.has_commands(robot)) {
            hash.add(robot);
            hash.add(world.devices.infrared[robot].is_muted);
        }
    }
    for (std::size_t lamp = 0; lamp < world.lamps.size(); ++lamp) {
        LampSetting const& setting = world.lamps[lamp].setting;
        if (setting != LampSetting()) {
            hash.add(lamp);
            hash.add(static_cast<int>(setting.is_on));
            hash.add(setting.intensity);
            hash.add(setting.moved_mm);
        }
    }
    for (Link const& link : world.links) {
        hash.add(static_cast<int>(link.kind));
        hash.add(link.a);
        hash.add(link.b);
        hash.add(static_cast<int>(link.is_cut));
        hash.add(link.tension_n);
    }
    if (controllers.own_memory() != nullptr) {
        add_own_memory(hash, controllers);
    }
    std::vector<std::byte> bytes;
    for (auto const& brain : brains) {
        brain->append_state(bytes);
    }
    hash.add_bytes(bytes);
    return mix64(hash.value());
}

}  // namespace pogosim
