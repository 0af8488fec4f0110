#include "physics/physics_engine.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>

namespace pogosim {

namespace {

struct Engine {
    std::string name;
    std::unique_ptr<PhysicsEngine> (*make)(World const&, WallSpec const&);
    std::string (*why_unfit)(World const&);
};

/// The first one is the automatic choice.
std::array<Engine, 2> const& engines() {
    static std::array<Engine, 2> const table{{
        {"box2d", make_box2d_engine, [](World const&) { return std::string(); }},
        {"disk", make_disk_engine, why_unfit_for_disk_engine},
    }};
    return table;
}

Engine const& engine_named(std::string const& name) {
    auto const found = std::ranges::find(engines(), name, &Engine::name);
    assert(found != engines().end() || name == kAutomaticEngine);
    return found != engines().end() ? *found : engines().front();
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

std::string const& physics_engine_behind(std::string const& name) {
    return engine_named(name).name;
}

std::string why_unfit(std::string const& name, World const& world) {
    return engine_named(name).why_unfit(world);
}

std::unique_ptr<PhysicsEngine> make_physics_engine(std::string const& name, World const& world, WallSpec const& walls) {
    return engine_named(name).make(world, walls);
}

}  // namespace pogosim
