#include "brain/driving.hpp"

#include "device/infrared.hpp"
#include "interface/pogobase_inside.hpp"

namespace pogosim {

void send_message(World& world, std::uint32_t robot, std::uint8_t emitters, std::span<std::byte const> payload) {
    if (is_muted_for_message(world, robot)) {
        return;
    }
    Packet const packet = long_packet(world, robot, emitters, power_list(world, robot, emitters), payload, ir_t_user);
    if (packet.radiates()) {
        transmit(world, robot, world.air, packet, watched_send_probability(world, robot));
    }
}

}  // namespace pogosim
