// Lamps at work. Each kind is one file with its make_lamp(), which turns the parameters of a lamp into something that
// writes light levels into the map.
//
//     spots that stand still    summed once, and again when a photo start changes one of them
//     spots on an orbit         added to that sum
//     rays                      overwrite the cells they light, the later lamp wins
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/arena.hpp"
#include "world/lamp_mark.hpp"
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

    /// Appends where it stands; nothing when it has no place because its light is the same everywhere.
    virtual void mark(LampState const& state, std::vector<LampMark>& marks) const = 0;
};

/// `map` gives the cells; its levels do not matter. All maps to paint on have the same cells.
std::unique_ptr<Lamp> make_lamp(SpotSpec const& spec, Arena const& arena, LightMap const& map);
std::unique_ptr<Lamp> make_lamp(RotatingRaySpec const& spec, Arena const& arena, LightMap const& map);
std::unique_ptr<Lamp> make_lamp(AlternatingRaysSpec const& spec, Arena const& arena, LightMap const& map);

}  // namespace pogosim
