#include "comms/ir_channel.hpp"

#include "comms/reception.hpp"

namespace pogosim {

void IrChannel::deliver(World& world) {
    if (world.air.transmissions.empty()) {
        return;
    }
    visibility_.update(world);
    for (Transmission const& transmission : world.air.transmissions) {
        deliver(world, transmission);
    }
    world.air.clear();
}

void IrChannel::deliver(World& world, Transmission const& transmission) {
    IrSpec const& ir = world.spec_of(transmission.robot).ir;
    auto const receivers =
        visibility_.receivers(world, transmission.robot, transmission.emitters, transmission.range_mm);
    if (receivers.empty()) {
        return;
    }
    auto const probability = static_cast<float>(reception_probability(ir.reception, transmission.message_bytes,
                                                                      transmission.send_probability,
                                                                      1.0 + static_cast<double>(receivers.size())));
    RandomStream& stream = world.robots.stream[transmission.robot];
    attempts_ += receivers.size();
    for (Receiver const& receiver : receivers) {
        if (stream.uniform() >= probability) {
            continue;
        }
        ++receptions_;
        std::uint8_t const faces =
            receiver.faces != 0
                ? receiver.faces
                : faces_that_see(world, receiver.robot, -receiver.from_emitter_mm, transmission.range_mm);
        FrameHeader header = transmission.header;
        for (unsigned face = 0; face < kFaceCount; ++face) {
            if ((faces >> face & 1U) != 0) {
                header.receiver_ir_index = static_cast<std::uint8_t>(face);
                world.mailboxes.push(receiver.robot, header, world.air.payload_of(transmission));
            }
        }
    }
}

}  // namespace pogosim
