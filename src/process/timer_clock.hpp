// What the timers of a thread go by.
#pragma once

namespace pogosim {

enum class TimerClock {
    processor,  // time for which the thread uses a processor
    wall,
};

}  // namespace pogosim
