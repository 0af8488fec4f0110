// Keeps everything on its side of soft membranes, whatever hits them.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/polygon.hpp"
#include "world/world.hpp"

namespace pogosim {

/// An engine's contacts and joints give way under blows and crowds that are too strong for its few iterations, and a
/// body whose centre is past the middle of a membrane is pushed on to the wrong side. So the sides are compared after
/// each step: a body that has changed sides is put back to its place before the step, at rest. If a body is still on
/// the wrong side, because the membrane has moved over it, the membrane is put back, too. All other bodies keep their
/// motion. Bodies that fit through the gaps between the bodies of a membrane may pass.
class MembraneSides {
public:
    /// Stores the present sides and poses.
    explicit MembraneSides(World const& world);

    /// To be called after a step of the engine. Returns the bodies that were put back.
    std::vector<std::uint32_t> const& hold(World& world);

    /// Stores sides and poses anew, after objects were moved from outside.
    void look_again(World const& world);

    /// What later steps depend on, see state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.sides_, self.poses_);
    }

private:
    struct Pose {
        Vec2 position_mm;
        float heading_rad = 0.0F;
        Vec2 heading_dir;
    };
    /// A membrane, and the bodies inside it that cannot pass: indices into World::bodies, ascending.
    struct Side {
        Membrane membrane;
        float least_radius_mm = 0.0F;             // smaller bodies may pass
        Polygon line{};                           // the present middle line of the membrane
        Box box{};                                // around it
        std::vector<std::uint32_t> was_inside{};  // before the step
        std::vector<std::uint32_t> is_inside{};   // and now

        template <class Self, class State>
        static void visit_state(Self& self, State& state) {
            state(self.was_inside, self.is_inside);
        }
    };

    bool any_body_crossed(World const& world);
    void find_lines(World const& world);
    void find_sides(World const& world);
    void put_back_crossed(Bodies& bodies, Side const& side);
    void put_back(Bodies& bodies, std::uint32_t i);
    void remember_poses(Bodies const& bodies);

    std::vector<Side> sides_;
    std::vector<std::vector<std::uint32_t>> sides_in_cell_;  // for each cell of a grid, those whose boxes touch it
    std::vector<Pose> poses_;                                // of all bodies, before the step
    std::vector<std::uint32_t> crossed_;                     // scratch
    std::vector<std::uint32_t> put_back_;
    std::vector<bool> is_back_;  // of all bodies, while bodies are put back
};

}  // namespace pogosim
