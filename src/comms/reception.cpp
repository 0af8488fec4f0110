#include "comms/reception.hpp"

#include <algorithm>

#include "base/exact_math.hpp"

namespace pogosim {

double reception_probability(ReceptionSpec const& spec, double message_bytes, double send_probability,
                             double cluster_size) {
    double const m = message_bytes;
    double const p = send_probability;
    double const c = cluster_size;
    double probability = spec.rate;
    switch (spec.law) {
        case ReceptionLaw::constant:
            break;
        case ReceptionLaw::article: {
            double const collisions = spec.beta * exact::pow(p, spec.gamma) * exact::pow(c, spec.delta);
            probability = 1.0 / (spec.alpha + collisions * exact::exp(spec.zeta * m) + spec.theta * p * c);
            break;
        }
        case ReceptionLaw::power:
            probability = 1.0 / (1.0 + spec.alpha * exact::pow(m, spec.beta) * exact::pow(p, spec.gamma) *
                                           exact::pow(c, spec.delta));
            break;
    }
    // With fitted parameters, the law may give values outside [0, 1], or no number.
    return probability > 0.0 ? std::min(probability, 1.0) : 0.0;
}

}  // namespace pogosim
