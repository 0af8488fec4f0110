#include "sim/make_links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/grid.hpp"
#include "base/log.hpp"
#include "config/places.hpp"
#include "sim/place_objects.hpp"
#include "world/link_places.hpp"

namespace pogosim {

namespace {

constexpr float kRadPerDegree = std::numbers::pi_v<float> / 180.0F;

// Neighbours in a lattice are this much nearer than what comes next, and their places are rounded.
constexpr float kSpacingTolerance = 0.01F;

// A rod needs a direction.
constexpr float kShortestRodMm = 1.0e-3F;
// One that fits its ends less would throw them.
constexpr float kMostMisfitMm = 1.0F;

/// An object that may be linked.
struct Member {
    std::uint32_t body = 0;
    std::size_t entry = 0;  // index into Scenario::objects
};

/// Two members, or one and a place of the arena.
struct Pair {
    std::uint32_t a = 0;  // number within the first category
    std::optional<std::uint32_t> b{};
    Vec2 place_mm{};  // without `b`
    std::optional<float> length_mm{};
};

/// The objects of a category in the order of their numbers.
std::vector<Member> members_of(Scenario const& scenario, World const& world, std::string const& category) {
    // All entries of this name have bodies, so there is a category of the world for each.
    std::vector<std::size_t> entries;
    for (std::size_t i = 0; i < scenario.objects.size(); ++i) {
        if (scenario.objects[i].category == category) {
            entries.push_back(i);
        }
    }
    std::vector<std::size_t> entry_of(world.categories.size());
    for (std::size_t i = 0, next = 0; i < world.categories.size(); ++i) {
        if (world.categories[i].name == category) {
            entry_of[i] = entries.at(next++);
        }
    }
    std::vector<Member> members;
    for (Object const& object : world.objects) {
        if (world.categories[object.category].name == category) {
            members.push_back({object.body, entry_of[object.category]});
        }
    }
    return members;
}

Vec2 out_of_frame(World const& world, std::uint32_t body, Vec2 offset) {
    return rotate(offset, world.bodies.heading_dir[body]);
}

/// The point of a shape's outline in a direction from its origin, both in the shape's own frame.
Vec2 rim_point(Shape const& shape, Vec2 towards) {
    float const distance = length(towards);
    Vec2 const way = distance > 0.0F ? (1.0F / distance) * towards : Vec2{1.0F, 0.0F};
    return reach(shape, way) * way;
}

/// Neighbours of a point among members.
class Neighbours {
public:
    struct Found {
        float squared_mm = 0.0F;
        std::uint32_t member = 0;

        friend auto operator<=>(Found const&, Found const&) = default;
    };

    Neighbours(World const& world, std::vector<Member> const& members) : world_(world) {
        for (Member const& member : members) {
            places_.push_back(world.bodies.position_mm[member.body]);
        }
        Vec2 const size = world.arena.bounds.size();
        typical_mm_ = std::sqrt(size.x * size.y / static_cast<float>(std::max<std::size_t>(members.size(), 1)));
        farthest_mm_ = length(size);
        grid_.build(places_, world.arena.bounds, typical_mm_, world.periodic);
    }

    /// Those within a distance of the point that `is_other` accepts, the nearest first.
    template <class Accepts>
    std::vector<Found> within(Vec2 point, float reach_mm, Accepts const& is_other) const {
        std::vector<Found> found;
        grid_.for_each_near(point, reach_mm, [&](std::uint32_t member, Vec2 place) {
            float const squared = squared_length(minimum_image(world_, point, place));
            if (squared <= reach_mm * reach_mm && is_other(member)) {
                found.push_back({squared, member});
            }
        });
        std::ranges::sort(found);
        return found;
    }

    /// At most so many of them.
    template <class Accepts>
    std::vector<Found> nearest(Vec2 point, std::size_t count, float reach_mm, Accepts const& is_other) const {
        float const last_mm = std::min(reach_mm, farthest_mm_);
        for (float tried_mm = typical_mm_;; tried_mm *= 2.0F) {
            std::vector<Found> found = within(point, std::min(tried_mm, last_mm), is_other);
            if (found.size() >= count || tried_mm >= last_mm) {
                found.resize(std::min(found.size(), count));
                return found;
            }
        }
    }

private:
    World const& world_;
    std::vector<Vec2> places_;
    UniformGrid grid_;
    float typical_mm_ = 0.0F;
    float farthest_mm_ = 0.0F;
};

/// Makes the links of one entry.
class LinkMaker {
public:
    LinkMaker(Scenario const& scenario, World& world, LinkConfig const& config)
        : scenario_(scenario),
          world_(world),
          config_(config),
          first_(members_of(scenario, world, config.between.front())),
          second_(config.has_two_categories() ? members_of(scenario, world, config.between.back()) : first_) {}

    void run() {
        auto const category = static_cast<std::uint32_t>(world_.link_categories.size());
        world_.link_categories.push_back({.name = config_.name, .are_drawn = config_.visible});
        std::vector<Pair> const pairs = pairs_of_topology();
        std::size_t const before = world_.links.size();
        for (Pair const& pair : pairs) {
            if (can_move(pair)) {
                world_.links.push_back(link_of(pair, category));
            }
        }
        if (world_.links.size() == before) {
            log().warn("{}: there are no such pairs of objects, so no links are made", place("topology"));
        }
    }

private:
    std::string place(std::string_view key) const { return place_of(scenario_, config_, key); }

    [[noreturn]] void fail(std::string const& where, std::string const& what) const {
        throw ConfigError(fmt::format("{}: {}", where, what));
    }

    Vec2 place_of_first(std::uint32_t number) const { return world_.bodies.position_mm[first_[number].body]; }

    bool is_same_category() const { return !config_.has_two_categories(); }

    /// The same for both orders of two objects of one category.
    std::pair<std::uint32_t, std::uint32_t> key_of(std::uint32_t a, std::uint32_t b) const {
        return is_same_category() ? std::pair(std::min(a, b), std::max(a, b)) : std::pair(a, b);
    }

    /// Numbers of the members of the first category that are to be linked, in this order.
    std::vector<std::uint32_t> chosen() const {
        if (config_.which == LinkedObjects::numbers) {
            return config_.numbers;
        }
        std::vector<std::uint32_t> numbers(first_.size());
        std::iota(numbers.begin(), numbers.end(), 0U);
        if (config_.which == LinkedObjects::rim) {
            Neighbours const neighbours(world_, first_);
            std::size_t const inside = scenario_.formation.lattice_kind == LatticeKind::square ? 4 : 6;
            std::erase_if(numbers, [&](std::uint32_t number) {
                return lattice_neighbours(number, first_, neighbours).size() == inside;
            });
        }
        return numbers;
    }

    /// Neighbours of a member of the first category among others that the same formation has placed.
    std::vector<std::uint32_t> lattice_neighbours(std::uint32_t number, std::vector<Member> const& others,
                                                  Neighbours const& neighbours) const {
        Member const& member = first_[number];
        ObjectConfig const& object = scenario_.objects[member.entry];
        float const reach_mm = (1.0F + kSpacingTolerance) * spacing_mm(member.entry);
        auto const is_other = [&](std::uint32_t i) {
            Member const& other = others[i];
            bool const is_apart =
                object.own_formation.is_given() || scenario_.objects[other.entry].own_formation.is_given();
            return other.body != member.body && (!is_apart || other.entry == member.entry);
        };
        std::vector<std::uint32_t> found;
        for (auto const& [squared, other] : neighbours.within(place_of_first(number), reach_mm, is_other)) {
            found.push_back(other);
        }
        std::ranges::sort(found);
        return found;
    }

    float spacing_mm(std::size_t entry) const {
        if (spacing_of_ != entry) {
            spacing_of_ = entry;
            spacing_mm_ = lattice_spacing_mm(scenario_, scenario_.objects[entry]);
        }
        return spacing_mm_;
    }

    std::vector<Pair> pairs_of_topology() const {
        switch (config_.topology) {
            case LinkTopology::triangular:
            case LinkTopology::square:
                return in_lattice();
            case LinkTopology::chain:
            case LinkTopology::ring:
                return in_order();
            case LinkTopology::nearest:
                return nearest_ones();
            case LinkTopology::list:
                return listed();
            case LinkTopology::fixed:
                return config_.file.empty() ? held() : held_at_places();
        }
        return {};
    }

    std::vector<Pair> in_lattice() const {
        std::vector<std::uint32_t> const numbers = chosen();
        std::set<std::uint32_t> const allowed(numbers.begin(), numbers.end());
        Neighbours const neighbours(world_, second_);
        std::vector<Pair> pairs;
        for (std::uint32_t const a : allowed) {
            for (std::uint32_t const b : lattice_neighbours(a, second_, neighbours)) {
                if (!is_same_category() || (a < b && allowed.contains(b))) {
                    pairs.push_back({.a = a, .b = b});
                }
            }
        }
        return pairs;
    }

    std::vector<Pair> in_order() const {
        std::vector<std::uint32_t> const numbers = chosen();
        std::vector<Pair> pairs;
        for (std::size_t i = 1; i < numbers.size(); ++i) {
            pairs.push_back({.a = numbers[i - 1], .b = numbers[i]});
        }
        if (config_.topology == LinkTopology::ring) {
            pairs.push_back({.a = numbers.back(), .b = numbers.front()});
        }
        return pairs;
    }

    std::vector<Pair> nearest_ones() const {
        Neighbours const neighbours(world_, second_);
        std::vector<std::uint32_t> const numbers = chosen();
        std::set<std::uint32_t> const allowed(numbers.begin(), numbers.end());
        std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
        for (std::uint32_t const a : numbers) {
            auto const is_other = [&](std::uint32_t i) {
                return second_[i].body != first_[a].body && (!is_same_category() || allowed.contains(i));
            };
            for (auto const& [squared, b] :
                 neighbours.nearest(place_of_first(a), static_cast<std::size_t>(config_.neighbours),
                                    static_cast<float>(config_.max_distance_mm), is_other)) {
                pairs.insert(key_of(a, b));
            }
        }
        std::vector<Pair> ordered;
        for (auto const& [a, b] : pairs) {
            ordered.push_back({.a = a, .b = b});
        }
        return ordered;
    }

    std::vector<Pair> listed() const {
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
        std::vector<Pair> pairs;
        for (ListedLink const& row : read_listed_links(config_.found_file, first_.size(), second_.size())) {
            if (is_same_category() && row.a == row.b) {
                fail(row.where, fmt::format("links object {} to itself", row.a));
            }
            if (!seen.insert(key_of(row.a, row.b)).second) {
                fail(row.where, fmt::format("links objects {} and {} a second time", row.a, row.b));
            }
            if (config_.kind == LinkKind::hinge && row.length_mm) {
                fail(row.where, "a hinge has no length; leave the column out");
            }
            pairs.push_back({.a = row.a, .b = row.b, .length_mm = row.length_mm});
        }
        return pairs;
    }

    std::vector<Pair> held() const {
        std::vector<Pair> pairs;
        for (std::uint32_t const a : chosen()) {
            std::uint32_t const body = first_[a].body;
            pairs.push_back({.a = a, .place_mm = place_on_body(world_.bodies, body, attached_at(body, {}))});
        }
        return pairs;
    }

    std::vector<Pair> held_at_places() const {
        std::set<std::uint32_t> seen;
        std::vector<Pair> pairs;
        for (ListedPlace const& row : read_listed_places(config_.found_file, first_.size())) {
            if (!seen.insert(row.a).second) {
                fail(row.where, fmt::format("holds object {} a second time", row.a));
            }
            pairs.push_back({.a = row.a, .place_mm = row.place_mm});
        }
        return pairs;
    }

    /// Links between bodies that are fixed do nothing.
    bool can_move(Pair const& pair) const {
        return !world_.bodies.spec[first_[pair.a].body].fixed ||
               (pair.b && !world_.bodies.spec[second_[*pair.b].body].fixed);
    }

    /// Where a body is linked, in its own frame; the other end is at this offset from its centre.
    Vec2 attached_at(std::uint32_t body, Vec2 to_other) const {
        switch (config_.attach) {
            case LinkAttachment::rim:
                return rim_point(world_.bodies.shape[body], in_frame_of(world_.bodies, body, to_other));
            case LinkAttachment::place:
                return config_.attach_mm;
            case LinkAttachment::centre:
                break;
        }
        return {};
    }

    Link link_of(Pair const& pair, std::uint32_t category) const {
        std::uint32_t const a = first_[pair.a].body;
        Link link;
        link.kind = config_.kind;
        link.a = a;
        link.link_category = category;
        if (pair.b) {
            link.b = second_[*pair.b].body;
        }
        if (config_.breaking_force_n) {
            link.breaking_n = *config_.breaking_force_n;
        }
        // From centre to centre, or to the place.
        Vec2 const to_mm = pair.b ? world_.bodies.position_mm[link.b] : pair.place_mm;
        Vec2 const apart = minimum_image(world_, world_.bodies.position_mm[a], to_mm);
        if (config_.kind == LinkKind::hinge) {
            set_hinge(link, pair, apart);
            return link;
        }
        link.end_a_mm = attached_at(a, apart);
        Vec2 span = apart - out_of_frame(world_, a, link.end_a_mm);
        if (pair.b) {
            link.end_b_mm = attached_at(link.b, -apart);
            span = span + out_of_frame(world_, link.b, link.end_b_mm);
        } else {
            link.end_b_mm = pair.place_mm;
        }
        // The place where it is held is where it is attached, but for rounding.
        bool const is_held = !pair.b && config_.file.empty();
        float const at_start_mm = is_held ? 0.0F : length(span);
        link.length_mm =
            pair.length_mm.value_or(config_.rest_length_mm ? static_cast<float>(*config_.rest_length_mm) : at_start_mm);
        if (config_.kind == LinkKind::spring) {
            link.stiffness_n_m = config_.stiffness_n_m;
            link.damping_n_s_m = config_.damping_n_s_m;
        } else if (link.length_mm < kShortestRodMm) {
            fail(place("type"), fmt::format("the rod of {} would have no length; use a hinge", named(pair)));
        } else if (std::abs(link.length_mm - at_start_mm) > kMostMisfitMm) {
            fail(place(pair.length_mm ? "file" : "rest_length"),
                 fmt::format("the rod of {} is to be {:g} mm long, but its ends are {:g} mm apart at the start",
                             named(pair), link.length_mm, at_start_mm));
        }
        return link;
    }

    void set_hinge(Link& link, Pair const& pair, Vec2 apart) const {
        if (pair.b) {
            link.end_a_mm = in_frame_of(world_.bodies, link.a, 0.5F * apart);
            link.end_b_mm = in_frame_of(world_.bodies, link.b, -0.5F * apart);
        } else {
            link.end_a_mm =
                config_.file.empty() ? attached_at(link.a, apart) : in_frame_of(world_.bodies, link.a, apart);
            link.end_b_mm = pair.place_mm;
        }
        float const of_b = pair.b ? world_.bodies.heading_rad[link.b] : 0.0F;
        link.rest_rad = wrap_angle(of_b - world_.bodies.heading_rad[link.a]);
        if (config_.limits_deg) {
            link.least_rad = kRadPerDegree * static_cast<float>(config_.limits_deg->min);
            link.most_rad = kRadPerDegree * static_cast<float>(config_.limits_deg->max);
        }
    }

    std::string named(Pair const& pair) const {
        std::string const first = fmt::format("{} {}", config_.between.front(), pair.a);
        return pair.b ? fmt::format("{} and {} {}", first, config_.between.back(), *pair.b) : first;
    }

    Scenario const& scenario_;
    World& world_;
    LinkConfig const& config_;
    std::vector<Member> first_;
    std::vector<Member> second_;
    mutable std::size_t spacing_of_ = std::numeric_limits<std::size_t>::max();
    mutable float spacing_mm_ = 0.0F;
};

}  // namespace

void make_links(Scenario const& scenario, World& world) {
    for (LinkConfig const& config : scenario.links) {
        LinkMaker(scenario, world, config).run();
    }
}

}  // namespace pogosim
