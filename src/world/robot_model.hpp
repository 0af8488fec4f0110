// What a robot has, and where: infrared faces, LEDs, light sensors, motors, chips and its processor. Plain data, one
// for each category: that of its type, or that of a file (`robot_model`, see docs/robot_models.md). The defaults are
// those of a Pogobot with wheels.
//
// Places and directions are in the robot's frame, x along its heading and y to its right:
//
//                 ^ x  front: face 0, LED 1
//       sensor 1  |  sensor 2                 sensors of light: 0 at the back, 1 front left, 2 front right
//     left 3 <----+----> right 1 y            motors: 0 right, 1 left, 2 back, as motor_id of Pogolib
//                 |
//              back 2, sensor 0
//
// Bounds here are those of the radio's header, which has two bits for a face, and of Pogolib.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec2.hpp"
#include "world/processor_spec.hpp"

namespace pogosim {

inline constexpr std::size_t kMostFaces = 4;
inline constexpr std::size_t kLedCount = 5;          // most of a robot: 0 head, 1 front, 2 right, 3 back, 4 left
inline constexpr std::size_t kPhotosensorCount = 3;  // most of a robot: 0 back, 1 front left, 2 front right
inline constexpr std::size_t kMotorCount = 3;        // most of a robot: 0 right, 1 left, 2 back

/// Where a part is: at `radii` times the radius of the robot's bounding circle, plus `offset_mm`.
struct PartPlace {
    Vec2 radii{};
    Vec2 offset_mm{};

    Vec2 at_mm(float radius_mm) const { return radius_mm * radii + offset_mm; }

    friend bool operator==(PartPlace const&, PartPlace const&) = default;
};

/// An infrared emitter and receiver.
struct Face {
    Vec2 normal{1.0F, 0.0F};  // outwards, unit vector
    PartPlace place{};
    float emission_deg = 180.0F;   // aperture: the whole angle of the cone around the normal, above 0 to 180
    float reception_deg = 180.0F;  // the same for what it hears

    friend bool operator==(Face const&, Face const&) = default;
};

/// An LED or a light sensor.
struct Part {
    Vec2 direction{};  // from the centre, unit vector; zero at the centre
    PartPlace place{};

    bool is_on_rim() const { return direction != Vec2{} && place == PartPlace{.radii = direction}; }

    friend bool operator==(Part const&, Part const&) = default;
};

/// A motor that moves the robot.
struct Drive {
    std::uint8_t motor = 0;    // motor_id
    std::uint8_t forward = 1;  // direction bit with which it turns forwards
    float linear = 0.0F;       // speed it gives at full power forwards, as a share of max_linear_speed_mm_s
    float angular = 0.0F;      // clockwise on the screen, as a share of max_angular_speed_rad_s

    friend bool operator==(Drive const&, Drive const&) = default;
};

/// Faces or sensors on the rim, with the normals (1, 0), (0, 1), (-1, 0), (0, -1): in front, right, back, left.
std::vector<Face> four_faces(bool at_centre);
std::vector<Part> head_and_four_leds();
std::vector<Part> three_light_sensors();
/// The right and the left motor: each gives half of the speed. `max_angular_speed_rad_s` is the scale that
/// configurations have had from the beginning: one motor alone turns the robot twice as fast, both against each other
/// four times.
std::vector<Drive> two_wheels();

struct RobotModel {
    bool sends_along_outline = false;  // one emitter and receiver, all along the object's outline, instead of faces
    std::vector<Face> faces = four_faces(/*at_centre=*/false);  // one to kMostFaces
    std::vector<Part> leds = head_and_four_leds();              // up to kLedCount
    std::vector<Part> light_sensors = three_light_sensors();    // up to kPhotosensorCount
    std::vector<Drive> drives = two_wheels();                   // empty: motors are inert
    bool has_magnetometer = true;
    std::uint32_t flash_pages = 5888;  // of 256 bytes
    ProcessorSpec processor{};

    bool has_motors() const { return !drives.empty(); }
    bool has_motor(int motor) const;  // 0 right, 1 left, 2 back
    /// Bit d: it has face d. An outline counts as all of them.
    std::uint8_t face_bits() const {
        std::size_t const count = sends_along_outline ? kMostFaces : faces.size();
        return static_cast<std::uint8_t>((1U << count) - 1U);
    }

    friend bool operator==(RobotModel const&, RobotModel const&) = default;
};

/// The head of a robot in the middle of a larger body, without motors and magnetometer: `pogobject`.
RobotModel head_model();
/// A robot without motors: `active_object`.
RobotModel active_model();
/// Walls and membranes.
RobotModel outline_model();

/// Unit vector of an angle in degrees, exact for right angles.
Vec2 direction_of_deg(double angle_deg);

}  // namespace pogosim
