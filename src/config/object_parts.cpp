#include "config/object_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "config/lamp_keys.hpp"
#include "config/scenario_keys.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

namespace {

std::span<Key<BodySpec> const> body_keys() {
    using K = Key<BodySpec>;
    static std::array const keys{
        K{"body_linear_damping", &BodySpec::linear_damping, at_least(0).up_to(1e12), "1/s",
          "Rate at which the speed of a free body decays; 0: it slides on without slowing down."},
        K{"body_angular_damping", &BodySpec::angular_damping, at_least(0).up_to(1e12), "1/s",
          "Rate at which the angular velocity of a free body decays; 0: it spins on without slowing down."},
        K{"body_density", &BodySpec::density, between(0, 1e15), "kg per (100 mm)^2",
          "Mass per area; below 1e-10, as light as with 1e-10."},
        K{"body_friction", &BodySpec::friction, between(0, 1000), "",
          "Coulomb friction coefficient; a contact uses the geometric mean of both bodies'."},
        K{"body_restitution", &BodySpec::restitution, between(0, 1), "",
          "Coefficient of restitution; a contact uses the larger of both bodies'."},
        K{"body_fixed", &BodySpec::fixed, any(), "",
          "Makes the object an immovable obstacle; not allowed for robots with wheels and membranes."},
    };
    return keys;
}

std::span<Key<BodySpec> const> blocking_keys() {
    using K = Key<BodySpec>;
    static std::array const keys{
        K{"blocks_infrared", &BodySpec::blocks_infrared, any(), "",
          "No message passes the object. A membrane blocks along the line through its bodies."}
            .left_out_at_default<&BodySpec::blocks_infrared, false>(),
    };
    return keys;
}

constexpr std::string_view kBlocksLight = "The object throws shadows in the light of lamps with `casts_shadows`.";

std::span<Key<BodySpec> const> shadow_keys() {
    using K = Key<BodySpec>;
    static std::array const keys{
        K{"blocks_light", &BodySpec::blocks_light, any(), "", kBlocksLight}
            .left_out_at_default<&BodySpec::blocks_light, true>(),
    };
    return keys;
}

/// Those of bodies that throw none by default.
std::span<Key<BodySpec> const> shadow_of_robot_keys() {
    using K = Key<BodySpec>;
    static std::array const keys{
        K{"blocks_light", &BodySpec::blocks_light, any(), "", kBlocksLight}
            .left_out_at_default<&BodySpec::blocks_light, false>(),
    };
    return keys;
}

std::span<Key<IrSpec> const> ir_keys() {
    using K = Key<IrSpec>;
    static std::array const keys{
        K{"communication_radius", &IrSpec::range_mm, kLengthOrZero, "mm",
          "Infrared range, from an emitter to the edge of the receiver; 0: mute."},
        K{"communication_radius_by_power", &IrSpec::range_by_power_mm, kLengthOrZero, "mm",
          "Range at the emitter powers 1, 2 and 3 of pogobot_infrared_set_power; default: communication_radius at all "
          "of them. Power 0 sends nothing."},
        K{"message_queue_size", &IrSpec::queue_size, between(1, 1000), "messages",
          "Capacity of a robot's queue of received messages; when it is full, new messages are dropped."},
        K{"msg_success_rate", Elsewhere{kReceptionMap}, any(), "",
          "Probability that a message in range is received; see its own table."},
    };
    return keys;
}

std::span<Key<RobotSpec> const> robot_keys() {
    using K = Key<RobotSpec>;
    constexpr auto has_motors = [](RobotSpec const& robot) { return robot.model.has_motors(); };
    static std::array const keys{
        K{"max_linear_speed", &RobotSpec::max_linear_speed_mm_s, between(0, 1e6).usually_from(1), "mm/s",
          "Speed with all motors at full power."}
            .only_if(has_motors),
        K{"max_angular_speed", &RobotSpec::max_angular_speed_rad_s, between(0, 1e4).usually_up_to(50), "rad/s",
          "Turning scale: with one motor at full power and the other stopped, the robot turns at twice this. With "
          "`motors`: the fastest turn on the spot."}
            .only_if(has_motors),
        K{"linear_noise_stddev", &RobotSpec::linear_noise_stddev, between(0, 1e4), "100 mm/s",
          "Standard deviation of Gaussian noise on each velocity component, drawn at every control tick."}
            .only_if(has_motors),
        K{"angular_noise_stddev", &RobotSpec::angular_noise_stddev, between(0, 1e4).usually_up_to(50), "rad/s",
          "Standard deviation of Gaussian noise on the angular velocity, drawn at every control tick."}
            .only_if(has_motors),
        K{"angular_systematic_bias_domain", &RobotSpec::motor_bias, between(-1023, 1023), "motor power units",
          "Each robot draws b from this range once; its left motor runs at power + b, its right motor at power - b."}
            .only_if(has_motors),
        K{"photosensors_systematic_bias_domain", &RobotSpec::photosensor_bias, between(-32767, 32767), "sensor counts",
          "Each light sensor draws a constant offset from this range once."},
        K{"photosensors_noise_stddev", &RobotSpec::photosensor_noise_stddev, between(0, 32767), "sensor counts",
          "Standard deviation of Gaussian noise on each light reading."},
        K{"magnetometer_enabled", &RobotSpec::magnetometer_enabled, any(), "",
          "Whether programs of these objects find a magnetometer."}
            .only_if([](RobotSpec const& robot) { return robot.model.has_magnetometer; }),
        K{"temporal_noise_stddev", &RobotSpec::clock_drift_stddev_us, between(0, 1e6), "us per tick",
          "Standard deviation of the constant clock drift, drawn once per robot."},
        K{"flash", one_of(&RobotSpec::flash, flash_writes()), any(), "",
          "A write to a page of flash memory. overwrite: it replaces the page. nor: as on the robot, it only clears "
          "bits, so the program must erase before it writes again. Default: `flash` of the top level, else overwrite."}
            .only_if([](RobotSpec const& robot) { return robot.flash.has_value(); }),
        K{"rotate_LEDs_45_deg", &RobotSpec::rotate_leds_45_deg, any(), "",
          "Drawing only: rotate the LEDs by 45 degrees; `leds` of a model that has others are drawn where they are."},
    };
    return keys;
}

/// Sets the defaults of all others.
std::span<Key<SensorSpec> const> sensor_model_keys() {
    using K = Key<SensorSpec>;
    static Choice<SensorSpec> const model = [] {
        Choice<SensorSpec> choice =
            one_of(&SensorSpec::model, {{"ideal", SensorModel::ideal}, {"robot", SensorModel::robot}});
        choice.set = [](SensorSpec& into, std::size_t index) { into = index == 0 ? SensorSpec() : kRobotSensors; };
        return choice;
    }();
    static std::array const keys{
        K{"sensor_model", model, any(), "",
          "ideal: sensors give exact numbers, and light up to 32767. robot: numbers of a real robot's chips, with "
          "light up to 1023, gravity, noise and whole counts; photosensors_bits and the keys that begin with imu_ may "
          "change each."},
    };
    return keys;
}

std::span<Key<SensorSpec> const> sensor_keys() {
    using K = Key<SensorSpec>;
    static std::array const keys{
        K{"photosensors_bits", &SensorSpec::photosensor_bits, between(1, kLightBits), "bits",
          "Bits of the light sensors' converter: it gives 0 to 2^bits - 1, which is 32767 in the light map. The real "
          "robot has 10."},
        K{"imu_gravity", &SensorSpec::imu_gravity, any(), "",
          "The accelerometer feels gravity, 9.80665 m/s2 on z at rest."},
        K{"imu_quantization", &SensorSpec::imu_quantization, any(), "",
          "Accelerometer and gyroscope give whole counts of 0.0047886 m/s2 and 0.00106528 rad/s."},
        K{"imu_acceleration_noise_stddev", &SensorSpec::acceleration_noise_m_s2, between(0, 1000), "m/s2",
          "Standard deviation of Gaussian noise on each reading and axis of the accelerometer."},
        K{"imu_angular_noise_stddev", &SensorSpec::angular_noise_rad_s, between(0, 1000), "rad/s",
          "Standard deviation of Gaussian noise on each reading and axis of the gyroscope."},
        K{"imu_acceleration",
          one_of(&SensorSpec::acceleration,
                 {{"robot", ImuAcceleration::robot}, {"original", ImuAcceleration::original}}),
          any(), "",
          "robot: m/s2, between the last two ticks. original: dm/s2 over the last physics step, as in the original "
          "simulator."},
    };
    return keys;
}

constexpr std::string_view kBatteryMap = "a map of keys, such as {capacity_mah: 250, idle_ma: 100}";

std::span<Key<BatterySpec> const> battery_keys() {
    using K = Key<BatterySpec>;
    static std::array const keys{
        K{"capacity_mah", &BatterySpec::capacity_mah, above(0).up_to(1e9), "mAh", "Charge of a full battery.",
          /*required=*/true},
        K{"idle_ma", &BatterySpec::idle_ma, between(0, 1e6), "mA",
          "Current of the processor and all that is always on."},
        K{"motor_ma", &BatterySpec::motor_ma, between(0, 1e6), "mA",
          "Current of one motor at full power; in proportion to its power below."},
        K{"led_ma", &BatterySpec::led_ma, between(0, 1e6), "mA",
          "Current of one LED that is white at full brightness (255, 255, 255); in proportion to the sum of its "
          "colours below."},
        K{"initial_percent", &BatterySpec::initial_percent, above(0).up_to(100), "%",
          "Charge at the start of the run."},
    };
    return keys;
}

std::span<Key<RobotSpec> const> battery_map_keys() {
    using K = Key<RobotSpec>;
    static std::array const keys{
        K{"battery", Elsewhere{kBatteryMap}, any(), "",
          "Battery that empties, see its own table; an empty one switches the robot off. Default: always full."},
    };
    return keys;
}

std::optional<BatterySpec> read_battery(MapReader& robot) {
    Node const* const map = robot.find("battery");
    if (map == nullptr) {
        return std::nullopt;
    }
    if (map->kind != Node::Kind::map) {
        fail_expected({*map, robot.path_of("battery")}, kBatteryMap);
    }
    MapReader reader(*map, robot.path_of("battery"), robot.reading());
    BatterySpec const battery = read_battery_map(reader);
    reader.finish();
    robot.set_value("battery", reader.values());
    return battery;
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
          "With y: initial position of all objects of the category; otherwise the formation places them."},
        K{"y", &Position::y, kCoordinate, "mm", "See x."},
        K{"angle", &Position::angle, kAngle, "rad",
          "With x and y: initial heading of all objects, clockwise on the screen from +x; default: 0."},
    };
    return keys;
}

}  // namespace

BatterySpec read_battery_map(MapReader& reader) {
    BatterySpec battery;
    reader.read(battery_keys(), battery);
    return battery;
}

void read_body(MapReader& reader, ObjectConfig& object) {
    constexpr float kLeastDensity = 1e-10F;
    BodySpec& body = object.spec.body.emplace();
    reader.read(body_keys(), body);
    body.density = std::max(body.density, kLeastDensity);
    // Real robots hardly throw shadows, and a membrane that throws one is dark inside.
    bool const lets_light_pass =
        object.spec.robot && (object.spec.robot->model.has_motors() || object.spec.robot->model.sends_along_outline);
    body.blocks_light = !lets_light_pass;
    reader.read(lets_light_pass ? shadow_of_robot_keys() : shadow_keys(), body);
}

void read_blocking(MapReader& reader, ObjectConfig& object) {
    reader.read(blocking_keys(), *object.spec.body);
}

void read_robot(MapReader& reader, ObjectConfig& object, RobotModel const& model) {
    RobotSpec& robot = object.spec.robot.emplace();
    robot.model = model;
    read_model(reader, robot);
    warn_of_parts_outside(reader, robot.model, bounding_radius(object.spec.shape));
    MotorSpeeds const of_motors{robot.max_linear_speed_mm_s, robot.max_angular_speed_rad_s};
    reader.read(robot_keys(), robot);
    tell_of_speeds(reader, robot, of_motors);
    reader.read(sensor_model_keys(), robot.sensors);
    reader.read(sensor_keys(), robot.sensors);
    reader.read(brain_keys(), robot);
    robot.brain = ScriptSpec();  // where it cannot be read, so that no program is asked for
    reader.collect([&] { robot.brain = read_brain(reader, robot.model); });
    reader.collect([&] { robot.function_costs = read_function_costs(reader); });
    reader.read(battery_map_keys(), robot);
    reader.collect([&] { robot.battery = read_battery(reader); });
    reader.read(ir_keys(), robot.ir);
    reader.collect([&] { robot.ir.reception = read_reception(reader); });
}

void read_position(MapReader& reader, ObjectConfig& object) {
    Position position;
    reader.read(position_keys(), position);
    if (auto const lone = reader.lone_key("x", "y")) {
        reader.refuse(lone->given, fmt::format("{} without {}; specify both or neither", lone->given, lone->missing));
        return;
    }
    if (position.x && position.y) {
        object.position_mm = Vec2{*position.x, *position.y};
        object.heading_rad = wrap_angle(position.angle.value_or(0.0F));
    } else if (position.angle && reader.find("x") == nullptr) {
        reader.refuse("angle", "angle without x and y; it is the heading of objects placed at x and y");
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
