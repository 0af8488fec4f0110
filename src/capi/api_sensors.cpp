// pogolib/sensors.h
#include <algorithm>
#include <cstdint>

#include "device/chips.hpp"
#include "device/imu.hpp"
#include "device/photosensors.hpp"
#include "robot/context.hpp"
#include "robot/require_robot.hpp"
#include "robot/robot_floating_point.hpp"
#include "robot/slip.hpp"
#include "robot/waiting.hpp"

using pogosim::context;
using pogosim::require_argument;
using pogosim::require_robot;

int16_t pogobot_photosensors_read(uint8_t sensor_number) {
    require_robot(__func__);
    pogosim::note_call();
    pogosim::take_back_floating_point();
    if (sensor_number >= pogosim::kPhotosensorCount) [[unlikely]] {
        pogosim::note_slip({__func__, "sensor_number", "p_B (0, back), p_FL (1, front left) or p_FR (2, front right)",
                            "-1 is returned"},
                           sensor_number);
        return -1;
    }
    if (!context.has_body()) {
        return -1;
    }
    if (sensor_number >= context.spec().model.light_sensors.size()) [[unlikely]] {
        pogosim::note_slip(
            {__func__, "sensor_number", "one of the light_sensors of this robot's model, from 0", "-1 is returned"},
            sensor_number);
        return -1;
    }
    pogosim::World& world = *context.world;
    if (world.lamps.empty()) [[unlikely]] {
        context.services->warn_once(
            "{}(): there is no lamp in this world, so it is dark everywhere; add an object of type static_light or "
            "another lamp to the configuration",
            __func__);
    }
    return pogosim::read_photosensor(world, context.robot, sensor_number);
}

void pogobot_imu_read(float* acc, float* gyro) {
    require_robot(__func__);
    require_argument(acc, __func__, "acc");
    require_argument(gyro, __func__, "gyro");
    pogosim::note_call();
    pogosim::take_back_floating_point();
    std::fill_n(acc, 3, 0.0F);
    std::fill_n(gyro, 3, 0.0F);
    if (!context.has_body()) {
        return;
    }
    auto const reading = pogosim::read_imu(*context.world, context.robot);
    std::ranges::copy(reading.acceleration, acc);
    std::ranges::copy(reading.angular_velocity, gyro);
}

float pogobot_imu_readTemp() {
    require_robot(__func__);
    return pogosim::thermometer_c(context.world->temperature_c,
                                  context.has_robot() ? context.spec().sensors.model : pogosim::SensorModel::ideal);
}
