#include "config/object_parts.hpp"

#include <array>
#include <optional>
#include <string_view>

#include "config/lamp_keys.hpp"
#include "config/reception_keys.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

namespace {

std::span<Key<BodySpec> const> body_keys() {
    using K = Key<BodySpec>;
    static std::array const keys{
        K{"body_linear_damping", &BodySpec::linear_damping, at_least(0).up_to(1e12), "1/s",
          "Rate at which the speed of a free body decays."},
        K{"body_angular_damping", &BodySpec::angular_damping, at_least(0).up_to(1e12), "1/s",
          "Rate at which the spin of a free body decays."},
        K{"body_density", &BodySpec::density, above(0).up_to(1e15), "per (100 mm)^2", "Mass per area."},
        K{"body_friction", &BodySpec::friction, between(0, 1000), "",
          "Coulomb friction coefficient; two touching bodies have the geometric mean."},
        K{"body_restitution", &BodySpec::restitution, between(0, 1), "",
          "Part of the approach speed kept after an impact; two touching bodies have the larger one."},
        K{"body_fixed", &BodySpec::fixed, any(), "",
          "An obstacle that never moves, whatever pushes it; not for robots with wheels and membranes."},
    };
    return keys;
}

std::span<Key<IrSpec> const> ir_keys() {
    using K = Key<IrSpec>;
    static std::array const keys{
        K{"communication_radius", &IrSpec::range_mm, kLengthOrZero, "mm",
          "Infrared reach, from an emitter to the border of the receiver; 0: mute."},
        K{"communication_radius_by_power", &IrSpec::range_by_power_mm, kLengthOrZero, "mm",
          "Reach at the emitter powers 1, 2 and 3 of pogobot_infrared_set_power; absent: communication_radius at all "
          "of them. Power 0 sends nothing."},
        K{"message_queue_size", &IrSpec::queue_size, between(1, 1000), "messages",
          "What a robot's queue of received messages holds; the newest is dropped when it is full."},
        K{"msg_success_rate", Elsewhere{kReceptionMap}, any(), "",
          "Probability that a message in reach is received, see its own table."},
    };
    return keys;
}

std::span<Key<RobotSpec> const> robot_keys() {
    using K = Key<RobotSpec>;
    constexpr auto has_wheels = [](RobotSpec const& robot) { return robot.has_wheels; };
    static std::array const keys{
        K{"max_linear_speed", &RobotSpec::max_linear_speed_mm_s, between(0, 1e6).usually_from(1), "mm/s",
          "Speed with both motors at full power."}
            .only_if(has_wheels),
        K{"max_angular_speed", &RobotSpec::max_angular_speed_rad_s, between(0, 1e4).usually_up_to(50), "rad/s",
          "Turning scale: one motor at full power and the other stopped turn at twice this."}
            .only_if(has_wheels),
        K{"linear_noise_stddev", &RobotSpec::linear_noise_stddev, between(0, 1e4), "100 mm/s",
          "Gaussian noise of each velocity component, drawn at every control tick."}
            .only_if(has_wheels),
        K{"angular_noise_stddev", &RobotSpec::angular_noise_stddev, between(0, 1e4), "rad/s",
          "Gaussian noise of the spin, drawn at every control tick."}
            .only_if(has_wheels),
        K{"angular_systematic_bias_domain", &RobotSpec::motor_bias, between(-1023, 1023), "motor power units",
          "A robot draws b from here once; its left motor runs at power + b, its right one at power - b."}
            .only_if(has_wheels),
        K{"photosensors_systematic_bias_domain", &RobotSpec::photosensor_bias, between(-32767, 32767), "sensor counts",
          "Each light sensor draws a constant offset from here once."},
        K{"photosensors_noise_stddev", &RobotSpec::photosensor_noise_stddev, between(0, 32767), "sensor counts",
          "Gaussian noise of each light reading."},
        K{"temporal_noise_stddev", &RobotSpec::clock_drift_stddev_us, between(0, 1e6), "us per tick",
          "Constant drift of a robot's clock, drawn once per robot."},
        K{"rotate_LEDs_45_deg", &RobotSpec::rotate_leds_45_deg, any(), "", "Drawing only: LEDs between the axes."},
    };
    return keys;
}

std::span<Key<ObjectSpec> const> colormap_keys() {
    using K = Key<ObjectSpec>;
    static std::array const keys{
        K{"colormap",
          one_of(&ObjectSpec::colormap, {{"rainbow", Colormap::rainbow}, {"qualitative", Colormap::qualitative}}),
          any(), "", "Drawing only: colours of the objects."},
    };
    return keys;
}

struct Position {
    std::optional<float> x;
    std::optional<float> y;
    std::optional<float> angle;
};

std::span<Key<Position> const> position_keys() {
    using K = Key<Position>;
    static std::array const keys{
        K{"x", &Position::x, kCoordinate, "mm",
          "With y: all objects of the category start there. Without: the formation places them."},
        K{"y", &Position::y, kCoordinate, "mm", "See x."},
        K{"angle", &Position::angle, kAngle, "rad",
          "With x and y: the heading of all objects at the start, clockwise on the screen from +x; absent: 0."},
    };
    return keys;
}

}  // namespace

void read_shape(MapReader& reader, std::span<Key<Shape> const> geometry_keys, Shape& shape) {
    reader.read(geometry_keys, shape);
    reader.read(size_keys(), shape);
}

void read_body(MapReader& reader, ObjectConfig& object) {
    reader.read(body_keys(), object.spec.body.emplace());
}

void read_robot(MapReader& reader, ObjectConfig& object, RobotSpec const& kind) {
    RobotSpec& robot = object.spec.robot.emplace(kind);
    reader.read(robot_keys(), robot);
    reader.read(ir_keys(), robot.ir);
    robot.ir.reception = read_reception(reader);
}

void read_position(MapReader& reader, ObjectConfig& object) {
    Position position;
    reader.read(position_keys(), position);
    if (position.x.has_value() != position.y.has_value()) {
        std::string_view const given = position.x ? "x" : "y";
        fail_at({*reader.find(given), reader.path_of(given)}, "stands alone; give both x and y, or neither");
    }
    if (position.x) {
        object.position_mm = Vec2{*position.x, *position.y};
        object.heading_rad = wrap_angle(position.angle.value_or(0.0F));
    } else if (position.angle) {
        fail_at({*reader.find("angle"), reader.path_of("angle")},
                "stands alone; it is the heading of objects at x and y");
    }
}

void ignore_position(MapReader& reader) {
    Position ignored;
    reader.read_unused(position_keys(), ignored);
}

void read_colormap(MapReader& reader, ObjectConfig& object) {
    reader.read(colormap_keys(), object.spec);
}

}  // namespace pogosim
