#include "sim/make_brains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <variant>

#include "base/error.hpp"
#include "brain/host_brain.hpp"
#include "brain/script_brain.hpp"

namespace pogosim {

namespace {

/// Firmware that has been read: categories may have the same.
class LoadedFirmware {
public:
    std::shared_ptr<FirmwareProgram const> of(RobotSpec const& robot) {
        auto const& spec = std::get<FirmwareSpec>(robot.brain);
        for (Loaded const& loaded : all_) {
            bool const is_same = loaded.spec.file == spec.file && loaded.spec.random == spec.random;
            if (is_same && loaded.processor == robot.model.processor) {
                return loaded.program;
            }
        }
        all_.push_back({spec, robot.model.processor, load_firmware(spec, robot.model.processor)});
        return all_.back().program;
    }

private:
    struct Loaded {
        FirmwareSpec spec;
        ProcessorSpec processor;
        std::shared_ptr<FirmwareProgram const> program;
    };
    std::vector<Loaded> all_;
};

bool is_driven_by_host(Category const& category) {
    return category.spec.robot && std::holds_alternative<HostSpec>(category.spec.robot->brain);
}

/// Several entries of a configuration may have the name of one category.
std::unique_ptr<Brain> host_brain_of_entries(World& world, std::uint32_t first, std::uint32_t last) {
    std::string const& name = world.categories[first].name;
    bool const has_others = std::ranges::any_of(std::span(world.categories).subspan(last), [&](Category const& other) {
        return other.name == name && is_driven_by_host(other);
    });
    if (has_others) {
        throw ConfigError(
            fmt::format("category '{}': its entries with brain: host have others between them; put them one behind "
                        "the other",
                        name));
    }
    RobotRange const robots{.first = robots_of(world, first).first, .last = robots_of(world, last - 1).last};
    return std::make_unique<HostBrain>(world, name, robots);
}

}  // namespace

Brains make_brains(World& world, FirmwareServices const& services) {
    Brains brains;
    LoadedFirmware firmware;
    auto const count = static_cast<std::uint32_t>(world.categories.size());
    for (std::uint32_t next = 0; next < count;) {
        std::uint32_t const first = next++;
        Category const& category = world.categories[first];
        if (is_driven_by_host(category)) {
            while (next < count && world.categories[next].name == category.name &&
                   is_driven_by_host(world.categories[next])) {
                ++next;
            }
            brains.push_back(host_brain_of_entries(world, first, next));
        } else if (category.spec.robot && std::holds_alternative<ScriptSpec>(category.spec.robot->brain)) {
            brains.push_back(std::make_unique<ScriptBrain>(world, first));
        } else if (category.spec.robot && std::holds_alternative<FirmwareSpec>(category.spec.robot->brain)) {
            brains.push_back(
                std::make_unique<FirmwareBrain>(world, first, firmware.of(*category.spec.robot), services));
        }
    }
    return brains;
}

void check_needs_no_program(World const& world) {
    for (std::uint32_t i = 0; i < world.categories.size(); ++i) {
        Category const& category = world.categories[i];
        bool const has_robots = robots_of(world, i).size() > 0;
        if (has_robots && category.spec.robot && needs_program(category.spec.robot->brain)) {
            throw ConfigError(
                fmt::format("category '{}' needs a program, and none is given: name one, or say what drives its robots "
                            "(brain: a script or a firmware; host in Python)",
                            category.name));
        }
    }
}

}  // namespace pogosim
