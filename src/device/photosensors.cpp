#include "device/photosensors.hpp"

#include <algorithm>

#include "device/chips.hpp"
#include "device/sensing.hpp"

namespace pogosim {

std::int16_t read_photosensor(World& world, std::uint32_t robot, std::size_t sensor) {
    RobotSpec const& spec = world.spec_of(robot);
    int level = light_at_sensor(world, robot, sensor) + world.devices.photosensor_bias[robot][sensor];
    if (float const noise = spec.photosensor_noise_stddev; noise > 0.0F) {
        level += static_cast<int>(noise * world.robots.stream[robot].normal());
    }
    level = converted_light(level, spec.sensors.photosensor_bits);
    return static_cast<std::int16_t>(std::clamp<int>(level, INT16_MIN, INT16_MAX));
}

}  // namespace pogosim
