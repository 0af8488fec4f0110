// The types of lamps that a configuration can name: a line for each. All else about it is in one file: its parameters,
// its keys and its light.
#include "lamps/lamp_types.hpp"

#include <array>
#include <span>

#include "config/object_types.hpp"
#include "lamps/alternating_rays_lamp.hpp"
#include "lamps/rotating_ray_lamp.hpp"
#include "lamps/spot_lamp.hpp"

namespace pogosim {

namespace {

constexpr std::array kLampTypes{
    ObjectType{"static_light", "Stationary lamp.", spot::read_static_light, DrawnAs::spot},
    ObjectType{"orbiting_static_light", "Lamp that moves along a circle.", spot::read_orbiting_static_light,
               DrawnAs::spot},
    ObjectType{"rotating_ray_of_light", "Lighthouse with one beam.", rotating_ray::read_rotating_ray_of_light,
               DrawnAs::beam},
    ObjectType{"alternating_rays_of_light", "Two lighthouses in two corners, active in turn.",
               alternating_rays::read_alternating_rays_of_light, DrawnAs::beam},
};

}  // namespace

std::span<ObjectType const> lamp_types() {
    return kLampTypes;
}

ObjectTypes const& object_types() {
    static ObjectTypes const types(lamp_types());
    return types;
}

}  // namespace pogosim
