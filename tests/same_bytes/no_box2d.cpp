// Box2D is not ours, and its bytes are not guaranteed.
#include <stdexcept>

#include "physics/physics_engine.hpp"

namespace pogosim {

std::unique_ptr<PhysicsEngine> make_box2d_engine(World const& /*world*/, WallSpec const& /*walls*/,
                                                 WorkerPool& /*workers*/) {
    throw std::logic_error("built without Box2D");
}

}  // namespace pogosim
