// The memory of robots that run firmware, for other processes' languages.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>

#include "base/error.hpp"
#include "firmware/firmware_brain.hpp"
#include "host/hosted_run.hpp"
#include "host/status.hpp"

using namespace pogosim;

namespace {

/// Whether two names lead to one file.
bool is_same_file(std::string const& one, std::string const& other) {
    std::error_code error;
    return one == other || std::filesystem::equivalent(one, other, error);
}

}  // namespace

int pogosim_run_firmware_bytes(pogosim_run const* run, char const* firmware, uint32_t address, uint32_t size,
                               void* bytes, uint8_t* runs_it) {
    return with_status_of(*run, [&] {
        Simulation const& simulation = run->simulation();
        std::span const into(static_cast<std::byte*>(bytes), simulation.world().robots.size() * std::size_t{size});
        std::ranges::fill(std::span(runs_it, simulation.world().robots.size()), std::uint8_t{0});
        for (auto const& brain : simulation.brains()) {
            auto const* const driver = dynamic_cast<FirmwareBrain const*>(brain.get());
            if (driver == nullptr || !is_same_file(driver->program()->file, firmware)) {
                continue;
            }
            for (std::uint32_t robot = driver->robots().first; robot < driver->robots().last; ++robot) {
                std::span const row = into.subspan(std::size_t{robot} * size, size);
                if (driver->robot(robot).memory.read(address, row).fault != AccessFault::none) {
                    throw ConfigError(fmt::format("robots have no {} bytes of memory at 0x{:08x}", size, address));
                }
                runs_it[robot] = 1;
            }
        }
        return POGOSIM_OK;
    });
}
