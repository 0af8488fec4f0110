// The state of everything, as plain data in structures of arrays. Each stage of a step reads the world and writes only
// its own part:
//
//   sim       writes  step; before the first step, all that the configuration determines, time_step_s last
//   light     writes  light.level: of all cells at first and when a still lamp or its shadow changes, otherwise of the
//                     cells under moving lamps
//   device    writes  devices, robots.led, robots.command, air; takes messages out of mailboxes; draws from
//                     robots.stream; for what drives the robots
//   comms     writes  mailboxes; clears air; draws from robots.stream
//   physics   writes  position_mm, heading_rad, heading_dir, velocity_mm_s, angular_velocity_rad_s, start_mm and
//                     start_rad of bodies; clears robots.command[i].pending; tension and is_cut of links
//   record, render and view only read
//
// Callbacks of the whole run, which run before the robots, also write poses, switched_off, the settings of lamps, and
// links with their link_categories (pogosim/world.h).
//
// No stage keeps a version of its own. What is written between two steps takes effect:
//
//   a pose, by set_pose()    bodies, also fixed ones, continue from there; outside walls
//   set_velocity()           bodies continue with it, unless their motors command another one
//   robots.led               is shown and recorded until the program sets it again
//   robots.command[i]        is the velocity of this body in the next step if it is pending, unless its motors
//                            command another one
//   light.level[i]           is sensed and shown until a lamp writes this cell
//   a message in a mailbox   is received
//   lamps[i].setting         determines the light of the next step
//   a link, made or cut      holds from the next step on, or no more; link_changes has to be counted up
//
// Everything else is constant during a run.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "geometry/arena.hpp"
#include "world/data_table.hpp"
#include "world/devices.hpp"
#include "world/link.hpp"
#include "world/magnetometer_spec.hpp"
#include "world/mailbox.hpp"
#include "world/rgb.hpp"
#include "world/specs.hpp"

namespace pogosim {

using Leds = std::array<Rgb, kLedCount>;

/// In place of an index: none.
inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// A body whose pose or velocity was written between two steps.
struct WrittenBody {
    std::uint32_t body = 0;
    bool is_moved = false;  // to another pose

    friend bool operator==(WrittenBody const&, WrittenBody const&) = default;
};

/// Rigid bodies. Shape: one entry per body.
struct Bodies {
    std::vector<Vec2> position_mm;
    std::vector<float> heading_rad;  // in (-pi, pi]: far from 0, a small turn would be rounded away
    std::vector<Vec2> heading_dir;   // unit vector along the heading; takes precedence over heading_rad
    std::vector<Vec2> velocity_mm_s;
    std::vector<float> angular_velocity_rad_s;  // clockwise on the screen
    std::vector<Vec2> start_mm;    // position and heading at the start of the last step, or where they have
    std::vector<float> start_rad;  // been put since, see observed_motion.hpp
    std::vector<float> radius_mm;  // bounding disk
    std::vector<Shape> shape;
    std::vector<BodySpec> spec;
    std::vector<WrittenBody> written;  // since the last step, in this order: the engine takes it over

    std::size_t size() const { return position_mm.size(); }

    friend bool operator==(Bodies const&, Bodies const&) = default;
};

/// A joint between two bodies.
struct Joint {
    std::uint32_t a = 0;  // indices into World::bodies
    std::uint32_t b = 0;
    Vec2 anchor_a_mm;  // point of attachment, in each body's own frame
    Vec2 anchor_b_mm;
    float length_mm = 0.0F;      // of the spring at rest; 0: a hinge
    float stiffness_hz = 0.0F;   // of the spring, with the masses at its ends
    float damping_ratio = 0.0F;  // 1: critical
    float max_stretch = 0.0F;    // a spring is never longer than 1 + this times its length; 0: no limit

    friend bool operator==(Joint const&, Joint const&) = default;
};

/// A ring of bodies, clockwise on the screen, that preserves the area it encloses.
struct Membrane {
    std::uint32_t body = 0;  // index into World::bodies, of the first of body_count
    std::uint32_t body_count = 0;

    friend bool operator==(Membrane const&, Membrane const&) = default;
};

/// The velocity that a robot's motors command.
struct VelocityCommand {
    Vec2 velocity_mm_s;
    float angular_velocity_rad_s = 0.0F;
    bool pending = false;  // set at a control tick, cleared when physics has imposed it

    friend bool operator==(VelocityCommand const&, VelocityCommand const&) = default;
};

/// Objects that run user code. Shape: one entry per robot, in order of creation.
struct Robots {
    std::vector<std::uint32_t> id;        // what the data file shows; on the air: id_on_air()
    std::vector<std::uint32_t> category;  // index into World::categories
    std::vector<std::uint32_t> body;      // index into World::bodies, the first one of a membrane; kNone: it has none
    std::vector<Leds> led;
    std::vector<VelocityCommand> command;
    std::vector<RandomStream> stream;  // noise of motors and sensors, losses on the air

    std::size_t size() const { return id.size(); }

    friend bool operator==(Robots const&, Robots const&) = default;
};

/// What a robot that is switched off goes on with.
struct SwitchedOff {
    std::uint32_t robot = 0;    // index into World::robots
    std::int64_t clock_us = 0;  // when it was switched off
    Leds leds{};

    friend bool operator==(SwitchedOff const&, SwitchedOff const&) = default;
};

/// Changes that a program or a host has made to a lamp.
struct LampSetting {
    bool is_on = true;
    float intensity = 1.0F;  // factor of the levels in the configuration
    Vec2 moved_mm;           // displacement from its place in the configuration

    friend bool operator==(LampSetting const&, LampSetting const&) = default;
};

/// A lamp; its light is computed in the room `light`.
struct PlacedLamp {
    std::string category;
    Vec2 start_mm;  // its place in the configuration, or the centre of its orbit
    LampSetting setting;

    Vec2 place_mm() const { return start_mm + setting.moved_mm; }

    friend bool operator==(PlacedLamp const&, PlacedLamp const&) = default;
};

struct Category {
    std::string name;
    ObjectSpec spec;

    friend bool operator==(Category const&, Category const&) = default;
};

/// One thing that the data file has a row for: it has a body, runs user code, or both.
struct Object {
    std::uint32_t id = 0;
    std::uint32_t category = 0;    // index into World::categories
    std::uint32_t robot = kNone;   // index into World::robots
    std::uint32_t body = kNone;    // index into World::bodies, of the first of body_count
    std::uint32_t body_count = 0;  // more than one: a membrane, in this order
    Vec2 fixed_mm{};               // its place if it has no body; for arena walls: the centre of their bounding box

    friend bool operator==(Object const&, Object const&) = default;
};

/// Where an object whose model sends along its outline sends and receives.
struct Outline {
    std::uint32_t robot = 0;        // index into World::robots
    std::vector<Polygon> polygons;  // mm, of a fixed object; empty: the outline runs through the bodies of a membrane
    std::uint32_t body = kNone;     // the membrane, as in Object
    std::uint32_t body_count = 0;

    friend bool operator==(Outline const&, Outline const&) = default;
};

/// Light levels on a grid over the bounding box of the outer wall. Row 0 lies along the top.
struct LightMap {
    int columns = 0;
    int rows = 0;
    Vec2 origin_mm;
    Vec2 cell_mm;
    bool periodic = false;            // what a lamp lights beyond one border is lit at the opposite one
    std::vector<std::int16_t> level;  // sensor counts, 0 to 32767, row by row

    /// Level of the cell under the point; outside the map, that of the nearest cell.
    std::int16_t at(Vec2 point_mm) const;

    friend bool operator==(LightMap const&, LightMap const&) = default;
};

/// Tolerance, in steps or periods, of a time that should be a whole number of them.
inline constexpr double kWholeTolerance = 1e-6;

struct World {
    // Time: a count of steps. time = step * time_step_s.
    std::int64_t step = 0;
    double time_step_s = 0.01;

    // Space.
    Arena arena;
    bool periodic = false;              // wrap at the bounding box of the outer wall; no walls
    bool ignore_occlusions = false;     // IR: range only, no half-plane test of emitters, no shadows
    bool walls_block_infrared = false;  // of a solid arena
    bool walls_block_light = true;      // the same; matters to lamps that cast shadows
    bool original_wall_copies =
        false;  // a wall's message arrives as often as in the original simulator, see Visibility
    float temperature_c = 42.0F;
    MagnetometerSpec magnetometer;

    // Things.
    std::vector<Category> categories;  // of objects, in the order of the configuration
    std::vector<Object> objects;       // in order of creation
    Bodies bodies;
    std::vector<Joint> joints;
    std::vector<Membrane> membranes;
    std::vector<LinkCategory> link_categories;  // in the order of the configuration
    std::vector<Link> links;
    std::uint32_t link_changes = 0;  // counts the times that links were made or cut; the engine follows it
    Robots robots;
    Devices devices;
    std::vector<std::uint32_t> switched_off;    // robots, ascending, by set_alive(): they are deaf and mute
    std::vector<SwitchedOff> when_switched_on;  // what these go on with, in the same order
    std::vector<Outline> outlines;
    std::vector<PlacedLamp> lamps;  // in the order of the configuration
    LightMap light;

    // Messages.
    TransmissionQueue air;
    Mailboxes mailboxes;

    double time_s() const { return static_cast<double>(step) * time_step_s; }

    RobotSpec const& spec_of(std::size_t robot) const { return *categories[robots.category[robot]].spec.robot; }

    /// Index into `devices` of a robot; of kNone: of callback_global_step.
    std::size_t device_of(std::uint32_t robot) const { return robot == kNone ? robots.size() : robot; }

    friend bool operator==(World const&, World const&) = default;
};

/// The id in pogobot_helper_getid() and in message headers. Robots have ids of 16 bits, so they repeat after 65536.
inline constexpr std::uint32_t kIdsOnAir = 65536;
constexpr std::uint16_t id_on_air(std::uint32_t id) {
    return static_cast<std::uint16_t>(id);
}

/// How many robots there are for people: not the walls and membranes that run programs.
std::size_t count_of_robots(World const& world);

/// Moves a body to another pose, at rest. One that is not finite is not written.
void set_pose(Bodies& bodies, std::uint32_t body, Vec2 position_mm, float heading_rad);

/// Gives a body another velocity. One that is not finite is not written; fixed bodies keep 0.
void set_velocity(Bodies& bodies, std::uint32_t body, Vec2 velocity_mm_s, float angular_velocity_rad_s);

/// Moves an object that has a body to another pose, at rest, even if it is fixed: a rigid body to this centre and
/// heading, a membrane without a change of shape to this middle.
void set_pose(World& world, Object const& object, Vec2 centre_mm, float heading_rad);

/// Whether a robot is switched on.
bool is_alive(World const& world, std::uint32_t robot);

/// Middle of an object: of its bodies, or its fixed place if it has none. Not wrapped.
Vec2 centre_mm(World const& world, Object const& object);

struct Pose {
    Vec2 position_mm;
    float heading_rad;  // [-pi, pi)
};

/// The pose that users see: the object's middle, wrapped into the arena if the world is periodic, and its heading, 0 if
/// it is not one rigid body.
Pose pose_of(World const& world, Object const& object);

/// Vector from `a` to `b` in a periodic world: the shortest one across the seams.
Vec2 minimum_image_across(World const& world, Vec2 a, Vec2 b);

/// Vector from `a` to `b`; the shortest one across the seam when the world is periodic.
inline Vec2 minimum_image(World const& world, Vec2 a, Vec2 b) {
    return world.periodic ? minimum_image_across(world, a, b) : b - a;
}

/// The offset that moves a point of a periodic world into the arena's bounding box; 0 inside.
Vec2 offset_into_bounds(World const& world, Vec2 point_mm);

/// The point wrapped into the arena's bounding box if the world is periodic; otherwise the point itself.
Vec2 wrapped(World const& world, Vec2 point_mm);

}  // namespace pogosim
