// Which robots a transmission reaches. Robots see each other with their emitters and faces, see emitter_view.hpp and
// faces.hpp. One that no face of its own hears is not reached, but hides others.
//
// Walls and membranes send and receive along their whole outline instead: only the distance from the outline to the
// robot's faces counts; there are no cones and no shadows.
//
// Blockers (infrared_blockers.hpp) then take away what they stand before: a robot if they cross the line from the
// sender's centre to the emitter, or on from there to the receiver's centre; a point of an outline if they cross the
// line from the robot's centre to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "comms/emitter_view.hpp"
#include "comms/faces.hpp"
#include "comms/infrared_blockers.hpp"
#include "comms/neighbour_cells.hpp"
#include "comms/outline_index.hpp"
#include "comms/receiver_cache.hpp"
#include "world/world.hpp"

namespace pogosim {

class Visibility {
public:
    /// Scratch memory of one search.
    struct Search {
        EmitterView view;
        NearbyBlockers blockers;
        std::vector<OutlineIndex::Piece> pieces;
        std::vector<std::uint8_t> outline_emitters;  // by outline: bit d: emitter d reaches it
        std::vector<Receiver> found;
    };

    /// Takes the present robots and outlines. Call before the queries, with the same world each time.
    void update(World const& world);

    /// The robots that the given emitters of `robot` (bit d: emitter d) reach at a range of `range_mm`: each once,
    /// through the nearest emitter that sees it, in the order of their indices. An outline has a single emitter, number
    /// 0. Robots that are switched off hide others, but receive nothing. With World::original_wall_copies, a robot
    /// stands in the list of an outline once for each face that hears it, unless all emitters send together. Valid
    /// until the next call.
    std::span<Receiver const> receivers(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm);

    /// What find() has found. The receivers are in the cache, or in the memory of the search.
    struct Found {
        std::span<Receiver const> receivers;
        std::span<Hearer const> hearers{};  // the same receivers, if they are in the cache; else empty
        bool is_worth_keeping = false;      // with keep()
    };

    /// The same, without changing the cache, so that several threads may search at once. Valid until the next search
    /// with that memory, or the next keep().
    Found find(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm, Search& search) const;

    /// Caches the receivers for as long as nothing within range moves. They must not be in the cache.
    void keep(std::uint32_t robot, std::uint8_t emitters, float range_mm, std::span<Receiver const> receivers) {
        cache_.store(robot, emitters, range_mm, cells_.changes(), receivers);
    }

    /// Faces of a receiver of a transmission of this range at which the message arrives: bit d for face d.
    std::uint8_t faces_of(World const& world, Receiver const& receiver, float range_mm) const;

    /// Vector from the centre of `robot`, which has a body, to the nearest point of the outline of `outline_robot`
    /// within `radius_mm`, one that no blocker hides if there is any. None: there is no such point.
    std::optional<Vec2> to_outline(World const& world, std::uint32_t robot, std::uint32_t outline_robot,
                                   float radius_mm);

private:
    /// Constants of a robot during a run.
    struct Sender {
        std::uint32_t body;   // kNone: along an outline
        std::uint32_t faces;  // index into faces_
    };

    /// What the constants depend on, to detect another world.
    struct Structure {
        std::size_t robots = 0;
        std::size_t bodies = 0;
        std::size_t outlines = 0;
        bool periodic = false;
        bool ignore_occlusions = false;
        bool walls_block_infrared = false;
        bool original_wall_copies = false;

        friend bool operator==(Structure const&, Structure const&) = default;
    };

    void start(World const& world);
    void note_switched(World const& world);
    bool is_unchanged(World const& world, std::uint32_t since, Sender const& sender, float range_mm) const;
    void find_anew(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm, Search& search,
                   std::vector<Receiver>& receivers) const;
    void add_robots_in_view(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm,
                            Search& search, std::vector<Receiver>& receivers) const;
    void add_outlines_near(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm,
                           Search& search, std::vector<Receiver>& receivers) const;
    void add_robots_near(World const& world, std::uint32_t outline, float range_mm, bool repeats, Search& search,
                         std::vector<Receiver>& receivers) const;
    std::uint8_t faces_near(World const& world, std::uint32_t robot, std::uint32_t outline, float range_mm,
                            Search& search) const;
    /// Radius around a sender's centre that contains the centres of all robots that it may reach.
    float search_radius_mm(Sender const& sender, float range_mm) const {
        return faces_[sender.faces].reach_mm + range_mm + largest_radius_mm_;
    }

    Structure structure_;
    /// What robots of one model and radius have in common.
    struct Make {
        std::uint32_t category;
        float radius_mm;
    };

    std::uint32_t faces_index(World const& world, std::uint32_t robot);
    void leave_out_deaf(World const& world, float range_mm, std::vector<Receiver>& receivers) const;

    std::vector<Sender> senders_;
    std::vector<Make> makes_;
    std::vector<Faces> faces_;  // of each make
    bool all_hear_around_ = true;
    float largest_radius_mm_ = 0.0F;
    NeighbourCells cells_;
    ReceiverCache cache_;
    std::vector<std::uint32_t> switched_off_;  // robots, at the last update
    OutlineIndex outlines_;
    InfraredBlockers blockers_;
    Search search_;
};

/// Distance from a robot's centre to its farthest face, mm: 0 at the centre, or for an outline.
float face_reach_mm(World const& world, std::uint32_t robot);

}  // namespace pogosim
