// What lamps cost in a step of the simulation: a light map of 100 x 100 cells, time steps of 0.01 s.
//
//     build/release/bench/bench_light
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "base/random.hpp"
#include "lamps/alternating_rays_lamp.hpp"
#include "lamps/rotating_ray_lamp.hpp"
#include "lamps/spot_lamp.hpp"
#include "light/lighting.hpp"
#include "support/small_world.hpp"

namespace {

using namespace pogosim;

constexpr Vec2 kCentre{500, 500};

/// Steps through the simulated time, past bodies that move all the time, if there are any.
void run(benchmark::State& state, std::vector<LampSpec> const& lamps, int bodies = 0) {
    World world = testing::square_world();
    world.light = make_light_map(world.arena, world.periodic, 100, 100);
    RandomStream random(1, 1);
    for (int i = 0; i < bodies; ++i) {
        testing::add_body(world, {random.uniform(20, 980), random.uniform(20, 980)}, 0.0F, testing::pogobot_spec());
    }
    Lighting lighting(lamps, world);
    for (auto _ : state) {
        lighting.update(world);
        benchmark::DoNotOptimize(world.light.level.data());
        benchmark::ClobberMemory();
        ++world.step;
        for (Vec2& position_mm : world.bodies.position_mm) {
            position_mm.x += world.step % 2 == 0 ? 1.0F : -1.0F;
        }
    }
}

SpotSpec ambient() {
    SpotSpec spec;
    spec.shape.kind = ShapeKind::global;
    spec.value = 200;
    return spec;
}

SpotSpec orbiting(LightMode mode, Shape const& shape) {
    SpotSpec spec;
    spec.shape = shape;
    spec.centre_mm = kCentre;
    spec.orbit = {.radius_mm = 200.0F, .angular_speed_rad_s = 1.0, .phase_rad = 0.0};
    spec.mode = mode;
    return spec;
}

SpotSpec still(LightMode mode, Shape const& shape) {
    SpotSpec spec = orbiting(mode, shape);
    spec.orbit = {};
    return spec;
}

RotatingRaySpec rotating(double half_width_rad) {
    RotatingRaySpec spec;
    spec.shape.kind = ShapeKind::global;
    spec.half_width_rad = half_width_rad;
    return spec;
}

AlternatingRaysSpec alternating() {
    AlternatingRaysSpec spec;
    spec.shape.kind = ShapeKind::global;
    return spec;
}

constexpr Shape kDisk{.kind = ShapeKind::disk, .radius_mm = 200.0F};
constexpr Shape kEverywhere{.kind = ShapeKind::global};

void register_all() {
    auto const add = [](char const* name, std::vector<LampSpec> const& lamps) {
        benchmark::RegisterBenchmark(name, [lamps](benchmark::State& state) { run(state, lamps); });
    };
    add("still lamps", {ambient(), ambient()});
    add("rotating ray, default width", {ambient(), rotating(0.1)});
    add("rotating ray, everywhere", {ambient(), rotating(3.1)});
    add("alternating rays", {ambient(), alternating()});
    add("orbiting disk, uniform", {ambient(), orbiting(LightMode::uniform, kDisk)});
    add("orbiting disk, gradient", {ambient(), orbiting(LightMode::gradient, kDisk)});
    add("orbiting everywhere, gradient", {ambient(), orbiting(LightMode::gradient, kEverywhere)});
    for (int const bodies : {1, 10, 100}) {
        LampSpec lamp = still(LightMode::gradient, kEverywhere);
        lamp.casts_shadows = true;
        std::string const name = "shadows of " + std::to_string(bodies) + " moving disks";
        benchmark::RegisterBenchmark(name.c_str(), [lamp, bodies](benchmark::State& state) {
            run(state, {ambient(), lamp}, bodies);
        });
    }
    add("all kinds at once", {ambient(), rotating(0.1), alternating(), orbiting(LightMode::gradient, kDisk)});
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
        return 2;
    }
    register_all();
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
