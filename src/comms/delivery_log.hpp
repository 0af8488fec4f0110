// The outcome of all transmissions of a step, for the message log.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// A transmission and one robot within its range, or a transmission without any robot in range.
struct Delivery {
    std::uint32_t transmission = 0;  // index into DeliveryLog::air
    std::uint32_t receiver = kNone;  // index of the robot; kNone: none in range, and the rest is unused
    std::uint32_t cluster_size = 1;  // the sender and the robots in range
    float probability = 0.0F;        // of reception
    float distance_mm = std::numeric_limits<float>::quiet_NaN();  // from the nearest emitter that reaches the receiver
                                                                  // to its border; NaN to or from an outline
    std::uint8_t emitters = 0;                                    // bit d: emitter d of the sender reaches it
    std::uint8_t faces = 0;                                       // bit d: face d of the receiver sees the emitter
    bool is_received = false;                                     // as drawn by the law of reception
    std::uint8_t queued = 0;  // copies, one per face, that found room in the receiver's queue
};

struct DeliveryLog {
    std::int64_t step = 0;             // in which they were sent
    TransmissionQueue air;             // the transmissions
    std::vector<Delivery> deliveries;  // transmission by transmission, receivers in the order of their indices
};

}  // namespace pogosim
