// pogolib/sensors.h
#include <algorithm>
#include <cstdint>

#include "device/chips.hpp"
#include "device/sensors.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"
#include "robot/robot_floating_point.hpp"
#include "robot/waiting.hpp"

using pogosim::context;
using pogosim::require_argument;
using pogosim::require_robot;

int16_t pogobot_photosensors_read(uint8_t sensor_number) {
    require_robot(__func__);
    pogosim::note_call();
    pogosim::take_back_floating_point();
    if (!pogosim::is_light_sensor(pogosim::own_model(), sensor_number, pogosim::NoteSlip{__func__}) ||
        !context.has_body()) {
        return -1;
    }
    pogosim::World& world = *context.world;
    if (world.lamps.empty()) [[unlikely]] {
        context.services->warn_once_of({.text = pogosim::kNoLamps}, "{}(): {}", __func__, pogosim::kNoLamps);
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
