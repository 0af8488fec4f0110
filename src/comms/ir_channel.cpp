#include "comms/ir_channel.hpp"

#include "comms/reception.hpp"

namespace pogosim {

void IrChannel::deliver(World& world) {
    if (world.air.emissions.empty()) {
        return;
    }
    visibility_.update(world);
    for (Emission const& emission : world.air.emissions) {
        deliver(world, emission);
    }
    world.air.clear();
}

void IrChannel::deliver(World& world, Emission const& emission) {
    IrSpec const& ir = world.spec_of(emission.robot).ir;
    auto const receivers = visibility_.receivers(world, emission.robot, emission.emitters, emission.range_mm);
    if (receivers.empty()) {
        return;
    }
    auto const probability = static_cast<float>(reception_probability(
        ir.reception, emission.message_bytes, emission.send_probability, 1.0 + static_cast<double>(receivers.size())));
    RandomStream& stream = world.robots.stream[emission.robot];
    attempts_ += receivers.size();
    for (Receiver const& receiver : receivers) {
        if (stream.uniform() >= probability) {
            continue;
        }
        ++receptions_;
        std::uint8_t const faces =
            receiver.faces != 0 ? receiver.faces
                                : faces_that_see(world, receiver.robot, -receiver.from_emitter_mm, emission.range_mm);
        FrameHeader header = emission.header;
        for (unsigned face = 0; face < kFaceCount; ++face) {
            if ((faces >> face & 1U) != 0) {
                header.receiver_ir_index = static_cast<std::uint8_t>(face);
                world.mailboxes.push(receiver.robot, header, world.air.payload_of(emission));
            }
        }
    }
}

}  // namespace pogosim
