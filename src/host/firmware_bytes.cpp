// The memory of robots that run firmware, for other processes' languages.
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "base/error.hpp"
#include "config/values.hpp"
#include "firmware/firmware_brain.hpp"
#include "host/hosted_run.hpp"
#include "host/status.hpp"

using namespace pogosim;

namespace {

/// Copies bytes of the memory of each robot that a brain drives, one after the other; returns what is left of `into`.
std::byte* copy_memory(FirmwareBrain const& brain, std::uint32_t address, std::uint32_t size, std::byte* into) {
    for (std::uint32_t robot = brain.robots().first; robot < brain.robots().last; ++robot) {
        if (brain.robot(robot).memory.read(address, {into, size}).fault != AccessFault::none) {
            throw ConfigError(fmt::format("robots have no {} bytes of memory at 0x{:08x}", size, address));
        }
        into += size;
    }
    return into;
}

}  // namespace

int pogosim_run_firmware_bytes(pogosim_run const* run, char const* category, uint32_t address, uint32_t size,
                               void* bytes) {
    return with_status_of(*run, [&] {
        auto* const begin = static_cast<std::byte*>(bytes);
        std::byte* into = begin;
        World const& world = run->simulation().world();
        for (auto const& brain : run->simulation().brains()) {
            auto const* const firmware = dynamic_cast<FirmwareBrain const*>(brain.get());
            if (firmware != nullptr && world.categories[firmware->category()].name == category) {
                into = copy_memory(*firmware, address, size, into);
            }
        }
        if (into == begin) {
            throw ConfigError(fmt::format("category '{}' does not run firmware", shown(category)));
        }
        return POGOSIM_OK;
    });
}
