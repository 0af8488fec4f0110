#pragma once

#include "base/log.hpp"

namespace pogosim {

/// The log that the calling thread uses: that of its LogScope, else that of the process.
Log& current_log();

}  // namespace pogosim
