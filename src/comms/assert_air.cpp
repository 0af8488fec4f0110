#include "comms/assert_air.hpp"

#include <cassert>
#include <cmath>

#ifndef NDEBUG
namespace pogosim {

void assert_air(World const& world) {
    assert(world.mailboxes.robot_count() == world.robots.size());
    for (Transmission const& transmission : world.air.transmissions) {
        assert(transmission.robot < world.robots.size());
        assert(transmission.emitters != 0 && (transmission.emitters & ~kAllFaces) == 0);
        assert(transmission.send_probability >= 0.0F && transmission.send_probability <= 1.0F);
        assert(std::isfinite(transmission.range_mm) && transmission.range_mm >= 0.0F);
        assert(transmission.message_bytes >= transmission.header.payload_length);
        assert(transmission.payload_offset + transmission.header.payload_length <= world.air.payloads.size());
    }
}

}  // namespace pogosim
#endif
