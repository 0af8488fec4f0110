// pogolib/sensors.h
#include <algorithm>
#include <cstdint>

#include "robot/chips.hpp"
#include "robot/context.hpp"
#include "robot/imu.hpp"
#include "robot/require_robot.hpp"
#include "robot/robot_floating_point.hpp"
#include "robot/sensing.hpp"
#include "robot/slip.hpp"
#include "robot/waiting.hpp"
#include "world/observed_motion.hpp"

using pogosim::context;
using pogosim::require_argument;
using pogosim::require_robot;
using pogosim::Vec2;

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
    pogosim::World& world = *context.world;
    if (world.lamps.empty()) [[unlikely]] {
        context.services->warn_once(
            "{}(): there is no lamp in this world, so it is dark everywhere; add an object of type static_light or "
            "another lamp to the configuration",
            __func__);
    }
    int level = pogosim::light_at_sensor(world, context.body(), sensor_number) +
                context.controller->photosensor_bias[sensor_number];
    float const noise = context.spec().photosensor_noise_stddev;
    if (noise > 0.0F) {
        level += static_cast<int>(noise * world.robots.stream[context.robot].normal());
    }
    level = pogosim::converted_light(level, context.spec().sensors.photosensor_bits);
    return static_cast<int16_t>(std::clamp<int>(level, INT16_MIN, INT16_MAX));
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
    pogosim::Controller& self = *context.controller;
    Vec2 const acceleration = pogosim::acceleration_m_s2(*context.world, context.body(), self.accelerometer);
    float const turning_rad_s = pogosim::observed_motion(*context.world, context.body()).angular_velocity_rad_s;
    auto const reading = pogosim::imu_reading(context.spec().sensors, acceleration, turning_rad_s, self.imu_noise);
    std::ranges::copy(reading.acceleration, acc);
    std::ranges::copy(reading.angular_velocity, gyro);
}

float pogobot_imu_readTemp() {
    require_robot(__func__);
    return pogosim::thermometer_c(context.world->temperature_c,
                                  context.has_robot() ? context.spec().sensors.model : pogosim::SensorModel::ideal);
}
