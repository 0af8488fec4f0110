#include "physics/physics_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>

namespace pogosim {

namespace {

constexpr std::string_view kBox2d = "box2d";

struct Engine {
    std::string name;
    std::unique_ptr<PhysicsEngine> (*make)(World const&, WallSpec const&, WorkerPool&);
};

/// The automatic choice is the first one.
std::array<Engine, 2> const& engines() {
    static std::array<Engine, 2> const table{{
        {"disk", make_disk_engine},
        {std::string(kBox2d), make_box2d_engine},
    }};
    return table;
}

Engine const& engine_for(std::string const& name) {
    auto const suits = [&](Engine const& engine) { return name == kAutomaticEngine || engine.name == name; };
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

std::string const& physics_engine_behind(std::string const& name) {
    return engine_for(name).name;
}

std::string why_unfit(std::string const& name, World const& world, bool has_box2d) {
    if (engine_for(name).name != kBox2d) {
        return "";
    }
    if (!has_box2d) {
        return fmt::format("is not there: this simulator was built without Box2D 2.4; use {}", kAutomaticEngine);
    }
    return world.periodic && !world.links.empty()
               ? fmt::format("does not hold links in a periodic arena; use {}", kAutomaticEngine)
               : "";
}

std::unique_ptr<PhysicsEngine> make_physics_engine(std::string const& name, World const& world, WallSpec const& walls,
                                                   WorkerPool& workers) {
    return engine_for(name).make(world, walls, workers);
}

}  // namespace pogosim
