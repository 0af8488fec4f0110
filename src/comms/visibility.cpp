#include "comms/visibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/counted.hpp"
#include "base/memory.hpp"
#include "geometry/polygon.hpp"

namespace pogosim {

namespace {

/// `v` in the frame whose x axis is the unit vector `axis`.
constexpr Vec2 in_frame_of(Vec2 v, Vec2 axis) {
    return {dot(axis, v), cross(axis, v)};
}

/// Index of the robot's outline. Outlines are in the order of the robots.
std::uint32_t outline_of(World const& world, std::uint32_t robot) {
    auto const found = std::ranges::lower_bound(world.outlines, robot, {}, &Outline::robot);
    return static_cast<std::uint32_t>(found - world.outlines.begin());
}

/// Those of the emitters (bit d: emitter d) before which no blocker stands: neither between the sender's centre and the
/// emitter, which may have got into a body a little, nor from there to the target, if there is one. All relative to the
/// sender's centre.
unsigned without_blocked(unsigned emitters, Faces const& faces, Vec2 axis, NearbyBlockers const& blockers,
                         std::optional<Vec2> target_mm = std::nullopt) {
    if (blockers.empty()) {
        return emitters;
    }
    unsigned open = 0;
    for (unsigned left = emitters; left != 0; left &= left - 1) {
        Vec2 const place = rotate(faces.place_mm[static_cast<unsigned>(std::countr_zero(left))], axis);
        if (!(target_mm ? blockers.block(place, *target_mm) : blockers.block({}, place))) {
            open |= left & -left;
        }
    }
    return open;
}

/// Whether a blocker stands between a robot's centre and a point of an outline, relative to it. One at the point itself
/// does not, such as the wall that sends.
bool is_hidden(Vec2 point, NearbyBlockers const& blockers) {
    constexpr float kAtMm = 0.1F;
    float const distance_mm = length(point);
    return distance_mm > kAtMm && blockers.block({}, (1.0F - kAtMm / distance_mm) * point);
}

}  // namespace

float face_reach_mm(World const& world, std::uint32_t robot) {
    RobotModel const& model = world.spec_of(robot).model;
    float reach_mm = 0.0F;
    for (Face const& face : model.sends_along_outline ? std::span<Face const>() : std::span(model.faces)) {
        reach_mm = std::max(reach_mm, length(face.place.at_mm(world.bodies.radius_mm[world.robots.body[robot]])));
    }
    return reach_mm;
}

/// Index of the faces of this robot's make, which are added if they are new.
std::uint32_t Visibility::faces_index(World const& world, std::uint32_t robot) {
    RobotModel const& model = world.spec_of(robot).model;
    std::uint32_t const category = world.robots.category[robot];
    float const radius_mm = model.sends_along_outline ? 0.0F : world.bodies.radius_mm[world.robots.body[robot]];
    auto const known = std::ranges::find_if(
        makes_, [&](Make const& make) { return make.category == category && make.radius_mm == radius_mm; });
    if (known != makes_.end()) {
        return static_cast<std::uint32_t>(known - makes_.begin());
    }
    makes_.push_back({category, radius_mm});
    faces_.push_back(model.sends_along_outline ? Faces() : make_faces(model, radius_mm));
    all_hear_around_ = all_hear_around_ && (model.sends_along_outline || faces_.back().hears_around);
    return static_cast<std::uint32_t>(faces_.size()) - 1;
}

void Visibility::start(World const& world) {
    senders_.clear();
    makes_.clear();
    faces_.clear();
    all_hear_around_ = true;
    largest_radius_mm_ = 0.0F;
    float longest_range_mm = 0.0F;
    for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
        RobotSpec const& spec = world.spec_of(i);
        bool const is_outline = spec.model.sends_along_outline;
        std::uint32_t const body = is_outline ? kNone : world.robots.body[i];
        senders_.push_back({.body = body, .faces = faces_index(world, i)});
        longest_range_mm = std::max(longest_range_mm, spec.ir.longest_range_mm());
        if (!is_outline) {
            largest_radius_mm_ = std::max(largest_radius_mm_, world.bodies.radius_mm[body]);
        }
    }
    cells_.start(world, longest_range_mm + 2.0F * largest_radius_mm_);
    blockers_.start(world);
    cache_.clear(world.robots.size());
    switched_off_ = world.switched_off;
}

void Visibility::update(World const& world) {
    Structure const structure{.robots = world.robots.size(),
                              .bodies = world.bodies.size(),
                              .outlines = world.outlines.size(),
                              .periodic = world.periodic,
                              .ignore_occlusions = world.ignore_occlusions,
                              .walls_block_infrared = world.walls_block_infrared,
                              .original_wall_copies = world.original_wall_copies};
    if (structure != structure_) {
        structure_ = structure;
        allocate_for([&] { return fmt::format("the neighbour grid of {}", counted(world.robots.size(), "robot")); },
                     std::nullopt, [&] { start(world); });
    }
    cells_.update(world);
    note_switched(world);
    blockers_.update(world, cells_);
    allocate_for([&] { return fmt::format("the outlines of {} walls and membranes", world.outlines.size()); },
                 std::nullopt,
                 [&] {
                     if (outlines_.update(world)) {
                         cells_.note_change_everywhere();
                     }
                 });
}

void Visibility::note_switched(World const& world) {
    if (world.switched_off == switched_off_) {
        return;
    }
    std::vector<std::uint32_t> switched;
    std::ranges::set_symmetric_difference(world.switched_off, switched_off_, std::back_inserter(switched));
    for (std::uint32_t const robot : switched) {
        cells_.note_change(robot);
    }
    switched_off_ = world.switched_off;
}

std::span<Receiver const> Visibility::receivers(World const& world, std::uint32_t robot, std::uint8_t emitters,
                                                float range_mm) {
    Found const found = find(world, robot, emitters, range_mm, search_);
    if (found.is_worth_keeping) {
        keep(robot, emitters, range_mm, found.receivers);
    }
    return found.receivers;
}

Visibility::Found Visibility::find(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm,
                                   Search& search) const {
    if (range_mm <= 0.0F) {
        return {};
    }
    Sender const& sender = senders_[robot];
    ReceiverCache::List const* const known = cache_.find(robot, emitters, range_mm);
    if (known != nullptr && is_unchanged(world, known->changes, sender, range_mm)) {
        return {.receivers = cache_.receivers(*known), .hearers = cache_.hearers(*known)};
    }
    std::vector<Receiver>& receivers = search.found;
    receivers.clear();
    find_anew(world, robot, emitters, range_mm, search, receivers);
    // Worth caching only if nothing has moved.
    bool const is_worth_keeping = is_unchanged(world, cells_.changes_before(), sender, range_mm);
    if (is_worth_keeping) {
        for (Receiver& receiver : receivers) {
            receiver.faces = faces_of(world, receiver, range_mm);
        }
    }
    return {.receivers = receivers, .is_worth_keeping = is_worth_keeping};
}

bool Visibility::is_unchanged(World const& world, std::uint32_t since, Sender const& sender, float range_mm) const {
    if (sender.body == kNone) {
        return cells_.is_unchanged(since);
    }
    return cells_.is_unchanged_near(since, world.bodies.position_mm[sender.body], search_radius_mm(sender, range_mm));
}

void Visibility::find_anew(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm,
                           Search& search, std::vector<Receiver>& receivers) const {
    if (senders_[robot].body != kNone) {
        blockers_.find_near(world, world.bodies.position_mm[senders_[robot].body],
                            search_radius_mm(senders_[robot], range_mm), search.blockers);
        add_robots_in_view(world, robot, emitters, range_mm, search, receivers);
        if (!all_hear_around_) {
            leave_out_deaf(world, range_mm, receivers);
        }
        if (!outlines_.empty()) {
            add_outlines_near(world, robot, emitters, range_mm, search, receivers);
        }
        std::sort(receivers.begin(), receivers.end(),
                  [](Receiver const& a, Receiver const& b) { return a.robot < b.robot; });
    } else if ((emitters & 1U) != 0) {
        bool const repeats = world.original_wall_copies && emitters != kAllFaces;
        add_robots_near(world, outline_of(world, robot), range_mm, repeats, search, receivers);
    }
    if (!world.switched_off.empty()) {
        std::erase_if(receivers, [&](Receiver const& receiver) { return !is_alive(world, receiver.robot); });
    }
}

void Visibility::add_robots_in_view(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm,
                                    Search& search, std::vector<Receiver>& receivers) const {
    Sender const& sender = senders_[robot];
    Vec2 const centre = world.bodies.position_mm[sender.body];
    Vec2 const axis = world.bodies.heading_dir[sender.body];
    Faces const& faces = faces_[sender.faces];
    float const rim_range_mm = faces.reach_mm + range_mm;
    EmitterView& view = search.view;
    view.clear();
    cells_.for_each_run_near(
        centre, search_radius_mm(sender, range_mm), [&](std::span<NeighbourCells::Neighbour const> neighbours) {
            view.expect(neighbours.size());
            for (NeighbourCells::Neighbour const& other : neighbours) {
                Vec2 const offset = minimum_image(world, centre, other.position_mm);
                float const limit_mm = rim_range_mm + other.radius_mm;
                bool const is_near = squared_length(offset) <= limit_mm * limit_mm;
                view.add_if(is_near & (other.robot != robot), other.robot, in_frame_of(offset, axis), other.radius_mm);
            }
        });
    unsigned const open = without_blocked(emitters & faces.all, faces, axis, search.blockers);
    for (EmitterView::Candidate seen : view.look(open, faces, range_mm, world.ignore_occlusions)) {
        seen.emitters = without_blocked(seen.emitters, faces, axis, search.blockers, rotate(seen.offset_mm, axis));
        if (seen.emitters != 0) {
            receivers.push_back({.robot = seen.robot,
                                 .from_emitter_mm = rotate(from_nearest_emitter_mm(seen, faces), axis),
                                 .emitters = static_cast<std::uint8_t>(seen.emitters)});
        }
    }
}

std::uint8_t Visibility::faces_of(World const& world, Receiver const& receiver, float range_mm) const {
    if (receiver.faces != 0) {
        return receiver.faces;
    }
    Sender const& disk = senders_[receiver.robot];
    return faces_that_see(faces_[disk.faces],
                          in_frame_of(-receiver.from_emitter_mm, world.bodies.heading_dir[disk.body]), range_mm,
                          world.ignore_occlusions);
}

/// Robots that do not hear the transmission, because their faces look elsewhere.
void Visibility::leave_out_deaf(World const& world, float range_mm, std::vector<Receiver>& receivers) const {
    for (Receiver& receiver : receivers) {
        receiver.faces = faces_of(world, receiver, range_mm);
    }
    std::erase_if(receivers, [](Receiver const& receiver) { return receiver.faces == 0; });
}

void Visibility::add_outlines_near(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm,
                                   Search& search, std::vector<Receiver>& receivers) const {
    std::uint32_t const body = senders_[robot].body;
    Faces const& faces = faces_[senders_[robot].faces];
    search.outline_emitters.assign(world.outlines.size(), 0);
    outlines_.find_near(world, world.bodies.position_mm[body], faces.reach_mm + range_mm, search.pieces);
    for (unsigned emitter = 0; emitter < kMostFaces; ++emitter) {
        unsigned const bit = 1U << emitter;
        if ((emitters & faces.all & bit) == 0) {
            continue;
        }
        Vec2 const place = rotate(faces.place_mm[emitter], world.bodies.heading_dir[body]);
        for (OutlineIndex::Piece const& piece : search.pieces) {
            std::uint8_t& reached = search.outline_emitters[piece.outline];
            if ((reached & bit) != 0) {
                continue;
            }
            Vec2 const point = nearest_on_segment(piece.from, piece.to, place);
            if (squared_length(place - point) <= range_mm * range_mm && !is_hidden(point, search.blockers)) {
                reached = static_cast<std::uint8_t>(reached | bit);
            }
        }
    }
    for (std::uint32_t i = 0; i < search.outline_emitters.size(); ++i) {
        if (search.outline_emitters[i] != 0) {
            receivers.push_back({.robot = world.outlines[i].robot,
                                 .faces = 1,
                                 .emitters = search.outline_emitters[i],
                                 .is_along_outline = true});
        }
    }
}

std::optional<Vec2> Visibility::to_outline(World const& world, std::uint32_t robot, std::uint32_t outline_robot,
                                           float radius_mm) {
    std::uint32_t const outline = outline_of(world, outline_robot);
    Vec2 const centre_mm = world.bodies.position_mm[world.robots.body[robot]];
    outlines_.find_near(world, centre_mm, radius_mm, search_.pieces);
    blockers_.find_near(world, centre_mm, radius_mm, search_.blockers);
    std::optional<Vec2> nearest;
    std::pair best{true, radius_mm * radius_mm};  // hidden, squared distance
    for (OutlineIndex::Piece const& piece : search_.pieces) {
        Vec2 const point = nearest_on_segment(piece.from, piece.to, {});
        if (piece.outline != outline || squared_length(point) > radius_mm * radius_mm) {
            continue;
        }
        std::pair const rank{is_hidden(point, search_.blockers), squared_length(point)};
        if (!nearest || rank < best) {
            nearest = point;
            best = rank;
        }
    }
    return nearest;
}

std::uint8_t Visibility::faces_near(World const& world, std::uint32_t robot, std::uint32_t outline, float range_mm,
                                    Search& search) const {
    std::uint32_t const body = world.robots.body[robot];
    Faces const& faces = faces_[senders_[robot].faces];
    unsigned hearing = 0;
    outlines_.find_near(world, world.bodies.position_mm[body], faces.reach_mm + range_mm, search.pieces);
    blockers_.find_near(world, world.bodies.position_mm[body], faces.reach_mm + range_mm, search.blockers);
    for (OutlineIndex::Piece const& piece : search.pieces) {
        for (unsigned face = 0; piece.outline == outline && (faces.all >> face) != 0; ++face) {
            Vec2 const place = rotate(faces.place_mm[face], world.bodies.heading_dir[body]);
            Vec2 const point = nearest_on_segment(piece.from, piece.to, place);
            if (squared_length(place - point) <= range_mm * range_mm && !is_hidden(point, search.blockers)) {
                hearing |= 1U << face;
            }
        }
    }
    return static_cast<std::uint8_t>(hearing);
}

void Visibility::add_robots_near(World const& world, std::uint32_t outline, float range_mm, bool repeats,
                                 Search& search, std::vector<Receiver>& receivers) const {
    Box const& box = outlines_.box(outline);
    Vec2 const middle = box.centre();
    Vec2 const half = 0.5F * box.size();
    for (std::size_t k = 0; k < cells_.size(); ++k) {
        std::uint32_t const robot = cells_.robot(k);
        // A robot hears an outline no further than its own range.
        float const both_range_mm = std::min(range_mm, world.spec_of(robot).ir.range_mm);
        float const margin_mm = both_range_mm + largest_radius_mm_;
        Vec2 const offset = minimum_image(world, middle, cells_.position_mm(k));
        if (std::abs(offset.x) > half.x + margin_mm || std::abs(offset.y) > half.y + margin_mm) {
            continue;
        }
        if (std::uint8_t const faces = faces_near(world, robot, outline, both_range_mm, search); faces != 0) {
            int const times = repeats ? static_cast<int>(count_of_four(faces)) : 1;
            receivers.insert(receivers.end(), static_cast<std::size_t>(times),
                             {.robot = robot, .faces = faces, .emitters = 1, .is_along_outline = true});
        }
    }
}

}  // namespace pogosim
