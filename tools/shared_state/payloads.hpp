// What a source file copies from the payload of a message, or takes it for.
#pragma once

#include <string>
#include <vector>

namespace shared_state {

struct PayloadUse {
    int line = 0;
    std::string message;    ///< the expression in front of "->payload", with "[]" for any element
    std::string arguments;  ///< as for sent_objects(): "&beacon, message->payload, sizeof(beacon)"
};

/// Finds calls of memcpy() and the like, casts, and pointers that are set to a payload. Debug information tells none of
/// that.
std::vector<PayloadUse> payload_uses(std::string text);

}  // namespace shared_state
