// In the place of box2d_engine.cpp, for a build without Box2D.
#include <stdexcept>

#include "physics/physics_engine.hpp"

namespace pogosim {

bool has_box2d_engine() {
    return false;
}

std::unique_ptr<PhysicsEngine> make_box2d_engine(World const& /*world*/, WallSpec const& /*walls*/,
                                                 WorkerPool& /*workers*/) {
    throw std::logic_error("built without Box2D");
}

}  // namespace pogosim
