#include "physics/physics_engine.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>

namespace pogosim {

namespace {

struct Engine {
    std::string name;
    std::unique_ptr<PhysicsEngine> (*make)(World const&, WallSpec const&, WorkerPool&);
    std::string (*why_unfit)(World const&);
};

/// The automatic choice is the first one that can move what is in the world. The last one can move everything.
std::array<Engine, 2> const& engines() {
    static std::array<Engine, 2> const table{{
        {"disk", make_disk_engine, why_unfit_for_disk_engine},
        {"box2d", make_box2d_engine, [](World const&) { return std::string(); }},
    }};
    return table;
}

Engine const& engine_for(std::string const& name, World const& world) {
    auto const suits = [&](Engine const& engine) {
        return name == kAutomaticEngine ? engine.why_unfit(world).empty() : engine.name == name;
    };
    auto const found = std::ranges::find_if(engines(), suits);
    assert(found != engines().end());
    return *found;
}

}  // namespace

std::vector<std::string> const& physics_engine_names() {
    static std::vector<std::string> const names = [] {
        std::vector<std::string> all{std::string(kAutomaticEngine)};
        std::ranges::transform(engines(), std::back_inserter(all), &Engine::name);
        return all;
    }();
    return names;
}

std::string const& physics_engine_behind(std::string const& name, World const& world) {
    return engine_for(name, world).name;
}

std::string why_unfit(std::string const& name, World const& world) {
    return engine_for(name, world).why_unfit(world);
}

std::unique_ptr<PhysicsEngine> make_physics_engine(std::string const& name, World const& world, WallSpec const& walls,
                                                   WorkerPool& workers) {
    return engine_for(name, world).make(world, walls, workers);
}

}  // namespace pogosim
