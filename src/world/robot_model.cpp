#include "world/robot_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/exact_math.hpp"

namespace pogosim {

namespace {

Part part_on_rim(double angle_deg) {
    Vec2 const direction = direction_of_deg(angle_deg);
    return {.direction = direction, .place = {.radii = direction}};
}

}  // namespace

Vec2 direction_of_deg(double angle_deg) {
    constexpr double right_angle_deg = 90.0;
    constexpr double radians = std::numbers::pi / 180.0;
    double const quarters = angle_deg / right_angle_deg;
    if (quarters == std::floor(quarters)) {
        switch (static_cast<int>(std::fmod(quarters, 4.0) + 4.0) % 4) {
            case 0:
                return {1.0F, 0.0F};
            case 1:
                return {0.0F, 1.0F};
            case 2:
                return {-1.0F, 0.0F};
            default:
                return {0.0F, -1.0F};
        }
    }
    auto const [sine, cosine] = exact::sine_cosine(angle_deg * radians);
    return {static_cast<float>(cosine), static_cast<float>(sine)};
}

std::vector<Face> four_faces(bool at_centre) {
    std::vector<Face> faces;
    for (double const angle_deg : {0.0, 90.0, 180.0, 270.0}) {
        Vec2 const normal = direction_of_deg(angle_deg);
        faces.push_back({.normal = normal, .place = {.radii = at_centre ? Vec2{} : normal}});
    }
    return faces;
}

std::vector<Part> head_and_four_leds() {
    return {{}, part_on_rim(0.0), part_on_rim(90.0), part_on_rim(180.0), part_on_rim(270.0)};
}

std::vector<Part> three_light_sensors() {
    return {part_on_rim(180.0), part_on_rim(320.0), part_on_rim(40.0)};
}

std::vector<Drive> two_wheels() {
    return {{.motor = 0, .forward = 0, .linear = 0.5F, .angular = -2.0F},
            {.motor = 1, .forward = 1, .linear = 0.5F, .angular = 2.0F}};
}

bool RobotModel::has_motor(int motor) const {
    return std::ranges::any_of(drives, [motor](Drive const& drive) { return drive.motor == motor; });
}

RobotModel head_model() {
    RobotModel model;
    model.faces = four_faces(/*at_centre=*/true);
    model.drives.clear();
    model.has_magnetometer = false;
    return model;
}

RobotModel active_model() {
    RobotModel model;
    model.drives.clear();
    return model;
}

RobotModel outline_model() {
    RobotModel model;
    model.sends_along_outline = true;
    model.drives.clear();
    model.has_magnetometer = false;
    return model;
}

}  // namespace pogosim
