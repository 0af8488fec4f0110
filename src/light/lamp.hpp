// Lamps at work. Each kind has a make_lamp(), which turns its parameters into something that writes light levels into
// the map. It gets a map for its cells, whose levels do not matter; all maps to paint on have the same cells.
//
//     spots that stand still    summed, and again when one of them or a shadow changes
//     spots on an orbit         added to that sum
//     rays                      overwrite the cells they light, the later lamp wins
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/arena.hpp"
#include "world/lamp_spec.hpp"
#include "world/specs.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Steps are counted, so a time that should be equal to another may differ from it in the last bits.
inline constexpr double kTimeToleranceS = 1e-6;

/// The state of a lamp at one moment, a function of the simulated time alone. Equal states light the same cells.
struct LampState {
    int phase = 0;           // the lamp's own numbering: dark, flash, ...
    double angle_rad = 0.0;  // of a beam or on an orbit; 0 where it does not matter

    friend bool operator==(LampState const&, LampState const&) = default;
};

/// Which light is put on the map first.
enum class Layer { still, moving, overwriting };

class Lamp {
public:
    virtual ~Lamp() = default;

    virtual Layer layer() const = 0;
    virtual LampState state_at(double time_s) const = 0;

    /// Puts its light on the map, and appends the cells it has written to `painted` (unless it is a still one).
    virtual void paint(LampState const& state, LightMap& map, std::vector<std::uint32_t>& painted) const = 0;

    /// Where its light comes from, for shadows. Not asked of light without a place.
    virtual Vec2 source_mm(LampState const& state) const = 0;

    /// Appends where it stands; nothing when it has no place because its light is the same everywhere.
    virtual void mark(LampState const& state, std::vector<LampMark>& marks) const = 0;
};

}  // namespace pogosim
