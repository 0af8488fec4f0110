#include "physics/soft_membranes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "physics/membrane_steps.hpp"

namespace pogosim {

namespace {

// Hinges answer to a push a few sub-steps later, as it has to travel round the membrane.
constexpr float kSwingsOfHinged = 0.0625F;

// Impulse that a spring without a limit never takes.
constexpr float kUnlimited = std::numeric_limits<float>::max();

/// Bodies of the world.
struct LineAtRest {
    std::span<Vec2 const> position_mm;

    std::size_t size() const { return position_mm.size(); }
    Vec2 position(std::size_t i) const { return position_mm[i]; }
    static Vec2 velocity(std::size_t /*i*/) { return {}; }
    static float inverse_mass(std::size_t /*i*/) { return 0.0F; }
    static void push(std::size_t /*i*/, Vec2 /*change*/) {}
};

/// Bodies of an island.
struct LineOfMovers {
    std::span<Mover> movers;

    std::size_t size() const { return movers.size(); }
    Vec2 position(std::size_t i) const { return movers[i].position_mm; }
    Vec2 velocity(std::size_t i) const { return movers[i].velocity_mm_s; }
    float inverse_mass(std::size_t i) const { return movers[i].inverse_mass; }
    void push(std::size_t i, Vec2 change) const { movers[i].velocity_mm_s = movers[i].velocity_mm_s + change; }
};

/// Lane l takes lane (l + kShift) % 4.
template <std::uint32_t kShift>
Four shifted(Four x) {
    return chosen_lanes<kShift, (kShift + 1) % kLanes, (kShift + 2) % kLanes, (kShift + 3) % kLanes>(x, x);
}

template <std::uint32_t kShift>
using Shift = std::integral_constant<std::uint32_t, kShift>;

/// Calls `what` with a shift that is known to the compiler.
template <class What>
auto with_shift(std::uint32_t shift, What what) {
    switch (shift) {
        case 0:
            return what(Shift<0>());
        case 1:
            return what(Shift<1>());
        case 2:
            return what(Shift<2>());
        default:
            return what(Shift<3>());
    }
}

Four shifted(Four x, std::uint32_t shift) {
    return with_shift(shift, [x](auto known) { return shifted<known>(x); });
}

}  // namespace

SoftMembranes::SoftMembranes(World const& world) {
    for (Membrane const& membrane : world.membranes) {
        // Joints are in the order of the membranes.
        auto const is_before = [](std::uint32_t body) { return [body](Joint const& joint) { return joint.a < body; }; };
        auto const first = std::ranges::partition_point(world.joints, is_before(membrane.body));
        auto const last = std::ranges::partition_point(world.joints, is_before(membrane.body + membrane.body_count));
        bool const has_hinges = std::any_of(first, last, [](Joint const& joint) { return joint.length_mm == 0.0F; });
        areas_.emplace_back(LineAtRest{std::span(world.bodies.position_mm).subspan(membrane.body, membrane.body_count)},
                            has_hinges ? kSwingsOfHinged : MembraneArea::kStiff);
        grouped_.emplace_back(world, membrane, static_cast<std::uint32_t>(first - world.joints.begin()),
                              static_cast<std::uint32_t>(last - first));
    }
}

void SoftMembranes::clear() {
    added_.clear();
    springs_.clear();
    rows_.clear();
}

template <class What>
void SoftMembranes::for_each_dot(Added const& added, What what) {
    SpringGroups const& grouped = grouped_[added.membrane];
    if (grouped.groups().empty()) {
        return;
    }
    std::span const rows = std::span(rows_).subspan(added.first_row, grouped.row_count());
    std::uint32_t const last = added.first_mover + grouped.dot_count();
    std::uint32_t mover = added.first_mover;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        for (std::size_t row = 0; row < rows.size() && mover < last; ++row) {
            what(mover++, rows[row], lane);
        }
    }
}

void SoftMembranes::add(World const& world, std::uint32_t membrane, std::span<Mover const> movers, std::uint32_t first,
                        std::span<SpringImpulse const> impulses) {
    SpringGroups const& grouped = grouped_[membrane];
    Added const added{.membrane = membrane,
                      .first_mover = first,
                      .first_row = static_cast<std::uint32_t>(rows_.size()),
                      .first_spring = static_cast<std::uint32_t>(springs_.size())};
    added_.push_back(added);
    if (grouped.groups().empty()) {
        return;
    }
    rows_.resize(rows_.size() + grouped.row_count());
    for_each_dot(added, [&](std::uint32_t mover, Row& row, std::uint32_t lane) {
        row.inverse_mass[lane] = movers[mover].inverse_mass;
    });
    Four const stiffest_hz = all_four(kMostSwingsPerStep / static_cast<float>(world.time_step_s));
    for (SpringGroup const& group : grouped.groups()) {
        Springs& springs = springs_.emplace_back();
        springs.row_a = added.first_row + group.row_a;
        springs.row_b = added.first_row + group.row_b;
        springs.shift = group.shift;
        springs.omega = 2.0F * std::numbers::pi_v<float> * smaller(group.stiffness_hz, stiffest_hz);
        springs.inverse_mass_a = rows_[springs.row_a].inverse_mass;
        springs.inverse_mass_b = shifted(rows_[springs.row_b].inverse_mass, group.shift);
        springs.inverse_mass = springs.inverse_mass_a + springs.inverse_mass_b;
        // Without a mass, nothing happens where a lane has no spring.
        FourInts const is_spring = (group.length_mm > 0.0F) & (springs.inverse_mass > 0.0F);
        springs.mass = is_spring ? 1.0F / springs.inverse_mass : Four{};
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
            if (group.joint[lane] != kNone) {
                springs.impulse[lane] = impulses[group.joint[lane]].spring;
                springs.limit[lane] = impulses[group.joint[lane]].limit;
            }
        }
    }
}

void SoftMembranes::forget_impulses() {
    for (Springs& springs : springs_) {
        springs.impulse = springs.limit = Four{};
    }
}

void SoftMembranes::keep_impulses(std::span<SpringImpulse> impulses) const {
    for (Added const& added : added_) {
        Springs const* springs = springs_.data() + added.first_spring;
        for (SpringGroup const& group : grouped_[added.membrane].groups()) {
            for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
                if (group.joint[lane] != kNone) {
                    impulses[group.joint[lane]] = {.spring = springs->impulse[lane], .limit = springs->limit[lane]};
                }
            }
            ++springs;
        }
    }
}

bool SoftMembranes::begin_substep(std::span<Mover> movers, float h_s, float push_rate) {
    for (Added const& added : added_) {
        std::uint32_t const count = grouped_[added.membrane].dot_count();
        areas_[added.membrane].push(LineOfMovers{movers.subspan(added.first_mover, count)}, h_s);
        for_each_dot(added, [&](std::uint32_t mover, Row& row, std::uint32_t lane) {
            row.x_mm[lane] = movers[mover].position_mm.x;
            row.y_mm[lane] = movers[mover].position_mm.y;
            row.x_mm_s[lane] = movers[mover].velocity_mm_s.x;
            row.y_mm_s[lane] = movers[mover].velocity_mm_s.y;
        });
    }
    FourInts are_too_long{};
    for (Added const& added : added_) {
        Springs* springs = springs_.data() + added.first_spring;
        for (SpringGroup const& group : grouped_[added.membrane].groups()) {
            are_too_long |= measure(*springs, group, h_s, push_rate);
            with_shift(group.shift, [&](auto shift) { push(*springs, springs->impulse + springs->limit, shift); });
            ++springs;
        }
        for_each_dot(added, [&](std::uint32_t mover, Row const& row, std::uint32_t lane) {
            movers[mover].velocity_mm_s = {row.x_mm_s[lane], row.y_mm_s[lane]};
        });
    }
    return is_any(are_too_long);
}

/// Returns which springs are too long.
FourInts SoftMembranes::measure(Springs& springs, SpringGroup const& group, float h_s, float push_rate) const {
    Row const& a = rows_[springs.row_a];
    Row const& b = rows_[springs.row_b];
    Four const x_mm = shifted(b.x_mm, springs.shift) - a.x_mm;
    Four const y_mm = shifted(b.y_mm, springs.shift) - a.y_mm;
    Four const now_mm = square_root(x_mm * x_mm + y_mm * y_mm);
    Four const per_mm = now_mm > 0.0F ? 1.0F / now_mm : Four{};
    springs.along_x = per_mm * x_mm;
    springs.along_y = per_mm * y_mm;
    springs.change_a_x = springs.inverse_mass_a * springs.along_x;
    springs.change_a_y = springs.inverse_mass_a * springs.along_y;
    springs.change_b_x = springs.inverse_mass_b * springs.along_x;
    springs.change_b_y = springs.inverse_mass_b * springs.along_y;
    Four const h_omega = h_s * springs.omega;
    springs.left = 1.0F / (1.0F + h_omega * (2.0F * group.damping_ratio + h_omega));
    springs.left_mass = springs.mass * springs.left;
    springs.soft_mass = springs.mass - springs.left_mass;
    springs.pull = springs.left_mass * (group.length_mm - now_mm) * h_omega * springs.omega;
    FourInts const is_limited = group.longest_mm > 0.0F;
    Four const slack_mm = group.longest_mm - now_mm;
    Four const most_mm_s = slack_mm > 0.0F ? slack_mm / h_s : slack_mm * push_rate;
    springs.most = is_limited ? springs.mass * most_mm_s : all_four(kUnlimited);
    springs.relaxed = larger(springs.most, Four{});
    return is_limited & (slack_mm < 0.0F);
}

void SoftMembranes::note_pushed(std::span<Mover const> movers, std::int32_t now, bool all) {
    pushed_.clear();
    others_.clear();
    for (Added const& added : added_) {
        for_each_dot(added, [&](std::uint32_t mover, Row const& row, std::uint32_t lane) {
            std::vector<Dot>& dots = all || movers[mover].changed == now ? pushed_ : others_;
            dots.push_back({mover, static_cast<std::uint32_t>(&row - rows_.data()), lane});
        });
    }
}

void SoftMembranes::read_velocities(std::span<Mover const> movers, std::span<Dot const> dots) {
    for (Dot const& dot : dots) {
        Row& row = rows_[dot.row];
        row.x_mm_s[dot.lane] = movers[dot.mover].velocity_mm_s.x;
        row.y_mm_s[dot.lane] = movers[dot.mover].velocity_mm_s.y;
    }
}

void SoftMembranes::write_velocities(std::span<Mover> movers, std::span<Dot const> dots) const {
    for (Dot const& dot : dots) {
        Row const& row = rows_[dot.row];
        movers[dot.mover].velocity_mm_s = {row.x_mm_s[dot.lane], row.y_mm_s[dot.lane]};
    }
}

void SoftMembranes::begin_iterations(std::span<Mover const> movers) {
    read_velocities(movers, others_);
}

void SoftMembranes::end_iterations(std::span<Mover> movers) const {
    write_velocities(movers, others_);
}

template <std::uint32_t kShift>
inline void SoftMembranes::push(Springs const& springs, Four impulse, Shift<kShift> /*shift*/) {
    Row& a = rows_[springs.row_a];
    a.x_mm_s -= impulse * springs.change_a_x;
    a.y_mm_s -= impulse * springs.change_a_y;
    // May be the same row.
    Row& b = rows_[springs.row_b];
    b.x_mm_s += shifted<(kLanes - kShift) % kLanes>(impulse * springs.change_b_x);
    b.y_mm_s += shifted<(kLanes - kShift) % kLanes>(impulse * springs.change_b_y);
}

/// Returns the changes of speeds. The terms are in such an order that few operations wait for the speed.
template <std::uint32_t kShift>
inline Four SoftMembranes::solve(Springs& springs, bool relaxes, Shift<kShift> shift) {
    Row const& a = rows_[springs.row_a];
    Row const& b = rows_[springs.row_b];
    Four const speed_mm_s = (shifted<kShift>(b.x_mm_s) - a.x_mm_s) * springs.along_x +
                            (shifted<kShift>(b.y_mm_s) - a.y_mm_s) * springs.along_y;
    Four const pull = springs.pull - springs.left * springs.impulse;
    Four const most = springs.limit - pull + (relaxes ? springs.relaxed : springs.most);
    Four const by_limit = smaller(most - springs.left_mass * speed_mm_s, Four{});
    Four const by_spring = springs.soft_mass * speed_mm_s;
    Four const change = (pull - springs.limit - by_spring) + by_limit;
    springs.impulse += pull - by_spring;
    springs.limit = by_limit;
    push(springs, change, shift);
    return larger(change, -change) * springs.inverse_mass;
}

float SoftMembranes::solve(std::span<Mover> movers, bool backwards, bool relaxes) {
    read_velocities(movers, pushed_);
    Four most_mm_s{};
    for (std::size_t i = 0; i < springs_.size(); ++i) {
        Springs& springs = springs_[backwards ? springs_.size() - 1 - i : i];
        most_mm_s =
            larger(most_mm_s, with_shift(springs.shift, [&](auto shift) { return solve(springs, relaxes, shift); }));
    }
    write_velocities(movers, pushed_);
    return -smallest(-most_mm_s)[0];
}

}  // namespace pogosim
