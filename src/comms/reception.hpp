// The probability that a message gets through.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "world/specs.hpp"

namespace pogosim {

/// Probability, in [0, 1], that one receiver gets a message.
/// `message_bytes`: header (3 in a short message, 8 in a long one) and payload; `send_probability`: the sender's chance
/// per tick, 0 to 1; `cluster_size`: the sender and the robots in range of the transmission, at least 1.
/// Source: the article's equation (Cazenille, Macabre, Bredeche, "Pogosim", eq. 1), fitted to measurements on robots.
double reception_probability(ReceptionSpec const& spec, double message_bytes, double send_probability,
                             double cluster_size);

// Cache of reception probabilities: in a quiet swarm, the powers and exponentials of the law cost more than everything
// else in the delivery of a message, and a category sends few kinds of messages to few sizes of clusters.

class ReceptionTable {
public:
    /// The same values as reception_probability().
    float probability(ReceptionSpec const& spec, std::uint16_t message_bytes, float send_probability,
                      std::uint32_t cluster_size) {
        Row& row = rows_[(cluster_size + 31U * message_bytes) % rows_.size()];
        if (row.cluster_size != cluster_size || row.message_bytes != message_bytes ||
            row.send_probability != send_probability) {
            row = {.cluster_size = cluster_size,
                   .message_bytes = message_bytes,
                   .send_probability = send_probability,
                   .probability =
                       static_cast<float>(reception_probability(spec, message_bytes, send_probability, cluster_size))};
        }
        return row.probability;
    }

private:
    struct Row {
        std::uint32_t cluster_size = 0;  // 0: empty
        std::uint16_t message_bytes = 0;
        float send_probability = 0.0F;
        float probability = 0.0F;
    };

    std::array<Row, 256> rows_;
};

}  // namespace pogosim
