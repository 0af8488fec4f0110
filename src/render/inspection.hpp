// What the inspector shows of one robot.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// A robot that can hear the inspected one now.
struct Neighbour {
    std::uint32_t id = 0;
    std::string category;
    float distance_mm = 0.0F;   // from the nearest emitter to its centre; of a wall or membrane, to its outline
    std::uint8_t emitters = 0;  // bit d: emitter d of the inspected robot reaches it
};

struct Inspection {
    static constexpr double kSpeedWindowS = 0.16;  // ten ticks of 60 Hz

    std::uint32_t robot = 0;  // index
    std::uint32_t id = 0;
    std::string category;
    bool has_body = false;     // else the pose and velocities are 0
    Vec2 position_mm;          // of a membrane: its middle; in a periodic arena inside its bounds
    float heading_rad = 0.0F;  // (-pi, pi]
    float speed_mm_s = 0.0F;   // mean of the last kSpeedWindowS
    float angular_velocity_rad_s = 0.0F;
    float moved_mm = 0.0F;         // in a straight line
    double moved_during_s = 0.0;   // duration of that motion: 1 s, or the whole run if it is shorter
    std::uint32_t links = 0;       // to other bodies, or the arena, that are not cut
    float least_tension_n = 0.0F;  // of these
    float most_tension_n = 0.0F;
    std::vector<std::string> touches;  // "wall", "robot 7", "obstacles 3"
    std::uint32_t ticks = 0;
    double clock_s = 0.0;                    // the robot's own: when its next tick is due
    std::array<int, 3> motor_power{};        // right, left, back; 0 to 1023
    std::array<int, 3> motor_direction{};    // 0 or 1
    Leds led{};                              // as set, 0 to 255
    std::vector<int> light;                  // of its light sensors, without noise and bias, sensor counts
    Vec2 acceleration_m_s2;                  // in the robot's frame, without noise
    std::array<int, 3> magnetometer{};       // x, y and z that its program has read last, counts
    std::uint64_t magnetometer_samples = 0;  // how often it has
    std::vector<Neighbour> neighbours;       // by id
    std::uint64_t messages_sent = 0;         // by any function; a message in all directions counts once
    bool is_muted = false;                   // it sends nothing
    std::uint64_t messages_received = 0;     // that its program has read
    std::size_t messages_waiting = 0;        // in its queue
    std::vector<std::pair<std::string, std::string>> variables;  // of its program, now: name and value
    std::string no_variables{};                                  // why there are none; empty: the program has none
    std::vector<std::pair<std::string, std::string>> columns;    // its last row of the data file: name and value
    double columns_time_s = 0.0;                                 // of that row
    std::vector<std::string> lines;                              // its last lines of printf, oldest first
};

/// What the data file recorded of the robots at one time: numbers of all columns that hold some.
struct RecordedValues {
    double time_s = 0.0;
    std::vector<std::uint32_t> robot;        // indices of the robots that have a row
    std::vector<std::vector<float>> values;  // by column, then as `robot`; NaN: no value
};

}  // namespace pogosim
