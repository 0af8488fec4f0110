// The probability that a message gets through.
#pragma once

#include "world/specs.hpp"

namespace pogosim {

/// Probability, in [0, 1], that one receiver gets a message.
/// `message_bytes`: header (3 in a short message, 8 in a long one) and payload; `send_probability`: the sender's chance
/// per tick, 0 to 1; `cluster_size`: the sender and the robots in range of the transmission, at least 1.
/// Source: the article's equation (Cazenille, Macabre, Bredeche, "Pogosim", eq. 1), fitted to measurements on robots.
double reception_probability(ReceptionSpec const& spec, double message_bytes, double send_probability,
                             double cluster_size);

}  // namespace pogosim
