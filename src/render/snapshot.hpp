// A copy of what a picture shows of the world at one moment, so that it can be drawn while the run goes on.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/arena.hpp"
#include "geometry/shape.hpp"
#include "render/trails.hpp"
#include "world/lamp_spec.hpp"
#include "world/world.hpp"

namespace pogosim {

/// The constant parts of a world that pictures need. Members as in World.
struct Scenery {
    Arena arena;
    bool periodic = false;
    std::vector<Category> categories;
    std::vector<Object> objects;
    std::vector<float> body_radius_mm;
    std::vector<Shape> body_shape;
    std::vector<std::uint32_t> robot_body;      // kNone: it has none
    std::vector<std::uint32_t> robot_category;  // index into `categories`
    std::vector<std::uint32_t> robot_id;
    std::vector<Outline> outlines;  // walls and membranes that run a program
};

Scenery make_scenery(World const& world);

/// Vector from one point to another; the shortest one across the seam of a periodic arena.
Vec2 minimum_image(Scenery const& scenery, Vec2 from_mm, Vec2 to_mm);

/// Two robots of which one hears the other, or both each other.
struct InfraredLink {
    std::uint32_t from = 0;  // indices of robots
    std::uint32_t to = 0;
    Vec2 from_mm;                    // on the rim of `from`, or its outline, towards `to`
    Vec2 to_mm;                      // on that of `to`; may lie beyond the seam of a periodic arena
    std::uint8_t emitters = 0;       // bit d: emitter d of `from` reaches `to`
    std::uint8_t emitters_back = 0;  // bit d: emitter d of `to` reaches `from`; 0: `to` only listens
};

/// A link between two bodies, or a body and the arena.
struct BodyLink {
    LinkKind kind = LinkKind::spring;
    bool is_pinned = false;  // to the arena, at `to_mm`
    Vec2 from_mm;
    Vec2 to_mm;         // may lie beyond the seam of a periodic arena
    float load = 0.0F;  // -1 to 1: tension by the breaking force, or by the largest tension; negative: it pushes
};

/// A message that another robot got.
struct HeardMessage {
    std::uint32_t sender = 0;  // indices of robots
    std::uint32_t receiver = 0;
    double time_s = 0.0;  // when it was delivered; the last one of these two
};

/// For so long, s, a picture shows that a robot heard another.
inline constexpr float kHeardForS = 1.0F;

/// A value of all robots.
struct RobotColumn {
    std::string name;
    std::string unit{};         // empty: it has none, or it is not known
    bool is_angle = false;      // rad
    std::vector<float> values;  // NaN: it has none
    float low = 0.0F;           // range of the colours: in a run, of all values so far; NaN: there are none
    float high = 0.0F;
};

/// Which parts of a snapshot that cost time are wanted.
struct SnapshotParts {
    bool light = false;
    bool links = false;
    bool trails = false;
    bool velocities = false;
    bool heard = false;
    std::string color_by{};  // names of RobotValues; empty: none
    std::string heat_map{};

    friend bool operator==(SnapshotParts const&, SnapshotParts const&) = default;
};

struct Snapshot {
    std::shared_ptr<Scenery const> scenery;
    std::int64_t step = 0;
    double time_s = 0.0;
    std::vector<Vec2> position_mm;   // of bodies; in a periodic arena inside its bounds
    std::vector<float> heading_rad;  // of bodies
    std::vector<Leds> led;           // of robots
    std::vector<LampMark> lamps;
    std::shared_ptr<LightMap const> light;  // null: not wanted
    std::vector<InfraredLink> links;        // empty: not wanted
    std::shared_ptr<Trails const> trails;   // null: not wanted
    std::vector<BodyLink> body_links{};
    std::vector<Vec2> velocity_mm_s{};      // of bodies; empty: not wanted
    std::vector<HeardMessage> heard{};      // in the last second; empty: not wanted
    std::optional<RobotColumn> color_by{};  // the value that colours bodies; absent: they have the colours of LEDs
    std::optional<RobotColumn> heat_map{};  // absent: not wanted, or of the density of robots
    std::vector<Rgb> shown_rgb{};  // the colour of each object, shown as it is, without a glow; empty: `led` says it
};

}  // namespace pogosim
