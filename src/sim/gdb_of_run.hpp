// Which robot of a run is debugged with gdb.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "firmware/gdb_session.hpp"
#include "world/world.hpp"

namespace pogosim {

struct GdbOptions {
    int port = 0;                          // 0: one that is free
    std::optional<std::uint32_t> robot{};  // its id; absent: the first one that runs firmware
    bool& ends_run;                        // set when gdb kills the program
};

/// Listens for gdb. `world` outlives the session. Throws ConfigError if there is no such robot, or it runs no firmware;
/// for a port, see GdbServer.
std::unique_ptr<GdbSession> gdb_of_run(World const& world, GdbOptions const& options);

}  // namespace pogosim
