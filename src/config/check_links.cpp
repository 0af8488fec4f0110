#include "config/check_scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/nearest_name.hpp"
#include "base/problems.hpp"
#include "config/places.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

[[noreturn]] void fail_link(Scenario const& scenario, LinkConfig const& link, std::string_view key,
                            std::string const& what) {
    throw KeyError(fmt::format("links.{}.{}", link.name, key),
                   fmt::format("{}: {}", place_of(scenario, link, key), what));
}

/// Why no object of this entry can be linked; empty: it can.
std::string obstacle_to_links(ObjectConfig const& object) {
    if (object.spec.lamp) {
        return "is a lamp";
    }
    if (object.spec.membrane) {
        return "is a membrane, of many bodies";
    }
    return object.spec.body ? "" : "has no body";
}

bool is_of_formation(ObjectConfig const& object) {
    return !object.position_mm && object.poses.empty();
}

void require_lattice(Scenario const& scenario, LinkConfig const& link, ObjectConfig const& object,
                     std::string_view key) {
    std::string const formation = object.own_formation.name.value_or(scenario.formation.name);
    std::string const kind = scenario.formation.lattice_kind == LatticeKind::square ? "square" : "triangular";
    if (!is_of_formation(object)) {
        fail_link(scenario, link, key,
                  fmt::format("needs objects in a lattice, and '{}' has places of its own (x and y, or poses); set "
                              "initial_formation: lattice in their place",
                              shown(object.category)));
    }
    if (!is_lattice(formation)) {
        fail_link(
            scenario, link, key,
            fmt::format("needs objects in a lattice, and '{}' is placed by '{}'; set initial_formation: lattice, or "
                        "choose another topology",
                        shown(object.category), formation));
    }
    bool const is_other = link.is_in_lattice() && (link.topology == LinkTopology::square) !=
                                                      (scenario.formation.lattice_kind == LatticeKind::square);
    if (is_other) {
        fail_link(scenario, link, key, fmt::format("the lattice is {} (lattice_kind); set both alike", kind));
    }
}

struct LinkedCategory {
    std::int64_t count = 0;
    bool can_move = false;
};

LinkedCategory check_category(Scenario const& scenario, LinkConfig const& link, std::string const& name) {
    LinkedCategory category;
    std::vector<std::string> known;
    bool is_known = false;
    for (ObjectConfig const& object : scenario.objects) {
        std::string const obstacle = obstacle_to_links(object);
        if (object.category != name) {
            if (obstacle.empty() && std::ranges::find(known, object.category) == known.end()) {
                known.push_back(object.category);
            }
            continue;
        }
        is_known = true;
        if (!obstacle.empty()) {
            fail_link(
                scenario, link, "between",
                fmt::format("'{}' {}; links hold robots and passive objects of one body each", shown(name), obstacle));
        }
        if (link.is_in_lattice()) {
            require_lattice(scenario, link, object, "topology");
        }
        if (link.which == LinkedObjects::rim) {
            require_lattice(scenario, link, object, "which");
        }
        category.count += object.nb;
        category.can_move = category.can_move || !object.spec.body->fixed;
    }
    if (!is_known) {
        fail_link(scenario, link, "between",
                  fmt::format("there is no category '{}' in 'objects'{}{}", shown(name),
                              known.empty() ? "" : fmt::format(" (those with bodies: {})", fmt::join(known, ", ")),
                              did_you_mean(shown(name), known)));
    }
    if (category.count == 0) {
        fail_link(scenario, link, "between", fmt::format("'{}' has no objects (nb: 0)", shown(name)));
    }
    return category;
}

bool takes_one_category(LinkTopology topology) {
    return topology == LinkTopology::chain || topology == LinkTopology::ring || topology == LinkTopology::fixed;
}

}  // namespace

void check_link(Scenario const& scenario, LinkConfig const& link) {
    if (link.has_two_categories() && takes_one_category(link.topology)) {
        fail_link(scenario, link, "between",
                  "chain, ring and fixed take one category; to link two of them, use topology nearest, list, "
                  "triangular or square");
    }
    if (link.which == LinkedObjects::rim && link.topology != LinkTopology::fixed) {
        fail_link(scenario, link, "which", "'rim' is for topology fixed; list the numbers of the objects");
    }
    bool const has_place = link.topology == LinkTopology::fixed && link.file.empty();
    if (link.attach == LinkAttachment::rim && has_place) {
        fail_link(scenario, link, "attach",
                  "there is no other end that a point of the rim could face; use center or [x, y], or a file with "
                  "places");
    }
    if (link.kind == LinkKind::rod && (link.rest_length_mm == 0.0 || (has_place && !link.rest_length_mm))) {
        fail_link(scenario, link, "type", "a rod needs a length (rest_length); to pin a point, use a hinge");
    }
    bool can_move = false;
    std::int64_t first_count = 0;
    for (std::string const& name : link.between) {
        LinkedCategory const category = check_category(scenario, link, name);
        can_move = can_move || category.can_move;
        first_count = first_count == 0 ? category.count : first_count;
    }
    if (!can_move) {
        fail_link(scenario, link, "between",
                  fmt::format("'{}' cannot move (body_fixed), so the links would do nothing",
                              fmt::join(link.between, "' and '")));
    }
    for (std::uint32_t const number : link.numbers) {
        if (number >= first_count) {
            fail_link(scenario, link, "which",
                      fmt::format("there is no object {} of '{}'; their numbers are 0 to {}", number,
                                  shown(link.between.front()), first_count - 1));
        }
    }
    std::int64_t const count =
        link.which == LinkedObjects::numbers ? static_cast<std::int64_t>(link.numbers.size()) : first_count;
    std::int64_t const least = link.topology == LinkTopology::chain ? 2 : link.topology == LinkTopology::ring ? 3 : 1;
    if (count < least) {
        fail_link(scenario, link, link.which == LinkedObjects::numbers ? "which" : "between",
                  fmt::format("a {} needs at least {} objects, found {}",
                              link.topology == LinkTopology::ring ? "ring" : "chain", least, count));
    }
}

}  // namespace pogosim
