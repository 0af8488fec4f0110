// What happens in some worlds, as hashes of all bits, one line each: the same with every compiler, at every level of
// optimisation, on every processor. expected.txt has the lines.
//
//     same_bytes [FOLDER OF ARENAS]
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/random.hpp"
#include "base/worker_pool.hpp"
#include "comms/ir_channel.hpp"
#include "geometry/arena.hpp"
#include "geometry/formation.hpp"
#include "lamps/alternating_rays_lamp.hpp"
#include "lamps/rotating_ray_lamp.hpp"
#include "lamps/spot_lamp.hpp"
#include "light/lighting.hpp"
#include "physics/physics_engine.hpp"
#include "support/shapes.hpp"
#include "support/small_world.hpp"

namespace {

using namespace pogosim;

std::filesystem::path arena_folder;

/// FNV-1a: G. Fowler, L. C. Noll, K.-P. Vo and D. Eastlake, "The FNV non-cryptographic hash algorithm" (IETF draft).
class Hash {
public:
    template <class T>
    void add(std::span<T const> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        for (std::byte const byte : std::as_bytes(values)) {
            hash_ = (hash_ ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3U;
        }
    }
    template <class T>
    void add(std::vector<T> const& values) {
        add(std::span<T const>(values));
    }
    std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325U;
};

void say(std::string const& what, std::int64_t number, Hash const& hash) {
    std::printf("%s %lld %016llx\n", what.c_str(), static_cast<long long>(number),
                static_cast<unsigned long long>(hash.value()));
}

Arena arena_of(std::string const& name, double surface_mm2) {
    return scale_arena(read_arena_file(arena_folder / (name + ".csv")), {surface_mm2, false});
}

/// Places of objects of several sizes, by each formation that computes them.
void place_objects() {
    std::vector<float> radii_mm(150, 26.5F);
    for (std::size_t i = 0; i < radii_mm.size(); i += 10) {
        radii_mm[i] = 40.0F;
    }
    for (std::string const& name : formation_names()) {
        if (name == kImportedFormation) {
            continue;
        }
        FormationSpec spec;
        spec.name = name;
        Hash hash;
        for (auto const* const arena : {"disk", "annulus", "H"}) {
            RandomStream random(11, 0);
            Arena const domain = arena_of(arena, 4e6);
            for (Placement const& placement : place(spec, radii_mm, {domain}, random)) {
                hash.add(std::span<Vec2 const>(&placement.position_mm, 1));
                hash.add(std::span<float const>(&placement.heading_rad, 1));
            }
        }
        say("formation " + name, 0, hash);
    }
}

void add_bodies(Hash& hash, World const& world) {
    hash.add(world.bodies.position_mm);
    hash.add(world.bodies.heading_rad);
    hash.add(world.bodies.heading_dir);
    hash.add(world.bodies.velocity_mm_s);
    hash.add(world.bodies.angular_velocity_rad_s);
}

/// Disks of two sizes, some of them fixed, in an arena.
World crowd(Arena const& arena, std::size_t count) {
    World world;
    world.arena = arena;
    RandomStream random(12, 0);
    FormationSpec spec;
    spec.name = "power_lloyd";
    std::vector<float> radii_mm(count, 26.5F);
    for (std::size_t i = 0; i < count; i += 20) {
        radii_mm[i] = 45.0F;
    }
    std::vector<Placement> const places = place(spec, radii_mm, {arena}, random);
    for (std::size_t i = 0; i < count; ++i) {
        ObjectSpec object = testing::pogobot_spec();
        object.shape.radius_mm = radii_mm[i];
        object.body = BodySpec{.linear_damping = 0.3F, .angular_damping = 0.5F, .fixed = i % 40 == 7};
        testing::add_robot(world, places[i].position_mm, places[i].heading_rad, object);
    }
    return world;
}

/// The same with others among them.
World mixture(Arena const& arena, std::size_t count, std::vector<Shape> const& shapes) {
    World world = crowd(arena, count);
    std::size_t next = 0;
    for (std::uint32_t i = 3; i < count; i += 5) {
        Shape const& shape = shapes[next++ % shapes.size()];
        world.bodies.shape[i] = shape;
        world.bodies.radius_mm[i] = bounding_radius(shape);
    }
    return world;
}

/// Robots in soft membranes that push each other.
World membranes(bool segments) {
    World world = testing::square_world();
    for (std::uint32_t i = 0; i < 24; ++i) {
        Vec2 const centre_mm{250.0F + 500.0F * static_cast<float>(i % 2), 500.0F};
        float const turn_rad = 0.26F * static_cast<float>(i);
        testing::add_robot(world, centre_mm + 140.0F * direction(turn_rad), 3.0F * turn_rad);
    }
    testing::add_ring(world, {.centre_mm = {250, 500}, .radius_mm = 220.0F, .segments = segments});
    testing::add_ring(world, {.centre_mm = {750, 500}, .radius_mm = 220.0F, .segments = segments});
    return world;
}

/// A lattice of robots: springs along its rows, rods and hinges across, and its first row held to the arena.
World lattice() {
    World world = testing::square_world();
    constexpr std::uint32_t side = 10;
    auto const link = [&](LinkKind kind, std::uint32_t a, std::uint32_t b, Vec2 end_a_mm, Vec2 end_b_mm) {
        world.links.push_back({.kind = kind,
                               .a = a,
                               .b = b,
                               .end_a_mm = end_a_mm,
                               .end_b_mm = end_b_mm,
                               .length_mm = 75.0F,
                               .stiffness_n_m = 200.0F,
                               .damping_n_s_m = 2.0F,
                               .breaking_n = 60.0F});
    };
    for (std::uint32_t i = 0; i < side * side; ++i) {
        Vec2 const place_mm{150.0F + 75.0F * static_cast<float>(i % side),
                            150.0F + 75.0F * static_cast<float>(i / side)};
        testing::add_robot(world, place_mm, 0.4F * static_cast<float>(i));
        if (i % side > 0) {
            link(LinkKind::spring, i - 1, i, {}, {});
        }
        if (i < side) {
            link(LinkKind::spring, i, kNone, {20.0F, 0.0F}, place_mm - Vec2{0.0F, 80.0F});
        } else if (i % 3 == 0) {
            link(LinkKind::rod, i - side, i, {}, {});
        } else if (i % 3 == 1) {
            link(LinkKind::hinge, i - side, i, rotate({0.0F, 37.5F}, direction(-0.4F * static_cast<float>(i - side))),
                 rotate({0.0F, -37.5F}, direction(-0.4F * static_cast<float>(i))));
            world.links.back().rest_rad = 4.0F;
            world.links.back().least_rad = -0.5F;
            world.links.back().most_rad = 0.5F;
        }
    }
    return world;
}

/// Motors as programs drive them, with noise: all robots wander, and every third one goes to the middle.
void drive(World& world) {
    Vec2 const middle_mm = world.arena.bounds.centre();
    for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
        RandomStream& random = world.robots.stream[i];
        Vec2 const way_mm = middle_mm - world.bodies.position_mm[i];
        Vec2 const ahead = i % 3 == 0 ? (1.0F / (1.0F + length(way_mm))) * way_mm : world.bodies.heading_dir[i];
        float const speed_mm_s = i % 50 == 1 ? 4000.0F : 90.0F + 5.0F * random.normal();
        world.robots.command[i] = {
            .velocity_mm_s = speed_mm_s * ahead, .angular_velocity_rad_s = 0.4F * random.normal(), .pending = true};
    }
}

void move(std::string const& what, World world) {
    WorkerPool workers(2);
    auto const engine = make_physics_engine("disk", world, WallSpec(), workers);
    for (world.step = 0; world.step < 300; ++world.step) {
        if (world.step % 2 == 0) {
            drive(world);
        }
        engine->advance(world);
        if (world.step % 100 == 99) {
            Hash hash;
            add_bodies(hash, world);
            say(what, world.step + 1, hash);
        }
    }
}

void move_mixture(std::string const& name, std::vector<Shape> const& shapes) {
    move(name, mixture(arena_of("annulus", 1.5e6), 250, shapes));
    World torus = mixture(arena_of("square", 1.2e6), 250, shapes);
    torus.periodic = true;
    move(name + " periodic", std::move(torus));
}

void send(World& world, std::uint32_t robot) {
    std::array<std::byte, 8> const payload{std::byte(robot), std::byte(world.step)};
    std::uint8_t const emitters = robot % 4 == 0 ? std::uint8_t{1} : kAllFaces;
    testing::send(world, robot, payload, {.emitters = emitters, .send_probability = 0.4F});
}

/// Robots that move and talk, with each law of reception.
void talk(std::string const& what, ReceptionSpec const& reception, bool is_periodic) {
    World world = crowd(arena_of("square", 9e5), 200);
    world.periodic = is_periodic;
    world.categories[0].spec.robot->ir.reception = reception;
    WorkerPool workers;
    auto const engine = make_physics_engine("disk", world, WallSpec(), workers);
    IrChannel channel;
    for (world.step = 0; world.step < 100; ++world.step) {
        drive(world);
        for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
            if (world.robots.stream[i].uniform() < 0.4F) {
                send(world, i);
            }
        }
        channel.deliver(world);
        engine->advance(world);
    }
    Hash hash;
    for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
        for (std::span<std::byte const> const waiting : world.mailboxes.waiting(i)) {
            hash.add(waiting);
        }
        float const next = world.robots.stream[i].uniform();
        hash.add(std::span<float const>(&next, 1));
    }
    std::array const counts{channel.attempts(), channel.receptions()};
    hash.add(std::span<std::uint64_t const>(counts));
    say(what, world.step, hash);
}

void light_up(std::string const& what, LampSpec const& lamp) {
    World world;
    world.arena = arena_of("disk", 1e6);
    world.light = make_light_map(world.arena, world.periodic, 100, 100);
    Lighting lighting({lamp}, world);
    Hash hash;
    RandomStream random(13, 0);
    for (world.step = 0; world.step < 1000; world.step += 10) {
        lighting.update(world);
        hash.add(world.light.level);
        Vec2 const place_mm{random.uniform(-500.0F, 1700.0F), random.uniform(-500.0F, 1700.0F)};
        std::int16_t const level = world.light.at(place_mm);
        hash.add(std::span<std::int16_t const>(&level, 1));
    }
    say(what, world.step, hash);
}

void light_all() {
    SpotSpec gradient;
    gradient.shape = {.kind = ShapeKind::disk, .radius_mm = 400.0F};
    gradient.centre_mm = {600, 500};
    gradient.mode = LightMode::gradient;
    gradient.value = 2000;
    gradient.orbit = {.radius_mm = 150.0F, .angular_speed_rad_s = 0.7, .phase_rad = 0.3};
    light_up("light gradient", gradient);

    SpotSpec plane = gradient;
    plane.mode = LightMode::plane;
    plane.plane_angle_rad = 0.6F;
    plane.orbit = {};
    light_up("light plane", plane);

    RotatingRaySpec ray;
    ray.shape.kind = ShapeKind::global;
    ray.half_width_rad = 0.15;
    light_up("light rotating_ray", ray);

    AlternatingRaysSpec rays;
    rays.shape.kind = ShapeKind::global;
    rays.half_width_rad = 0.1;
    light_up("light alternating_rays", rays);
}

}  // namespace

int main(int count, char** arguments) {
    arena_folder = count > 1 ? arguments[1] : POGOSIM_SOURCE_DIR "/arenas";
    place_objects();
    move("crowd disk", crowd(arena_of("disk", 1.2e6), 250));
    move("crowd annulus", crowd(arena_of("annulus", 1.5e6), 250));
    World torus = crowd(arena_of("square", 1.2e6), 250);
    torus.periodic = true;
    move("crowd periodic", std::move(torus));
    move_mixture("boxes and wedges", {testing::rectangle(45.0F, 20.0F), testing::triangle(45.0F)});
    move_mixture("other shapes",
                 {testing::capsule(50.0F, 16.0F),
                  testing::polygon({{-25.0F, 0.0F}, {-10.0F, -20.0F}, {18.0F, -12.0F}, {22.0F, 9.0F}, {-4.0F, 21.0F}}),
                  testing::rounded(testing::triangle(45.0F), 6.0F), testing::tray(40.0F, 40.0F, 6.0F)});
    move("membranes", membranes(/*segments=*/false));
    move("membranes of segments", membranes(/*segments=*/true));
    move("links", lattice());
    talk("messages article", {.law = ReceptionLaw::article}, false);
    talk("messages power", four_parameter_law(), true);
    talk("messages constant", {.law = ReceptionLaw::constant, .rate = 0.7}, false);
    light_all();
    return 0;
}
