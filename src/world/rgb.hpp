// The colour of an LED.
#pragma once

#include <cstdint>

namespace pogosim {

struct Rgb {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;

    friend bool operator==(Rgb const&, Rgb const&) = default;
};

}  // namespace pogosim
