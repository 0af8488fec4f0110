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
    std::string (*why_unfit)(World const&);
};

/// The automatic choice is the first one that can move what is in the world. The last one can move everything.
std::array<Engine, 2> const& engines() {
    static std::array<Engine, 2> const table{{
        {"disk", make_disk_engine, why_unfit_for_disk_engine},
        {std::string(kBox2d), make_box2d_engine, [](World const&) { return std::string(); }},
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

std::string why_unfit(std::string const& name, World const& world, bool has_box2d) {
    Engine const& engine = engine_for(name, world);
    std::string const no_disks = why_unfit_for_disk_engine(world);
    bool const is_missing = engine.name == kBox2d && !has_box2d;
    if (is_missing && no_disks.empty()) {
        return fmt::format("is not there: this simulator was built without Box2D 2.4; use {}", kAutomaticEngine);
    }
    if (is_missing) {
        return fmt::format(
            "has no engine for it: disk {}, and this simulator was built without Box2D 2.4; use type: membrane",
            no_disks);
    }
    std::string const reason = engine.why_unfit(world);
    return reason.empty() ? "" : fmt::format("{}; use {}", reason, has_box2d ? "auto or box2d" : "type: membrane");
}

std::unique_ptr<PhysicsEngine> make_physics_engine(std::string const& name, World const& world, WallSpec const& walls,
                                                   WorkerPool& workers) {
    return engine_for(name, world).make(world, walls, workers);
}

}  // namespace pogosim
