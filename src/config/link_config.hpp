// One entry of `links`: which objects are linked, and by what.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/vec2.hpp"
#include "world/link.hpp"
#include "world/magnetometer_spec.hpp"

namespace pogosim {

/// Which objects are linked to which.
enum class LinkTopology {
    triangular,  // neighbours in a lattice of this kind
    square,
    chain,    // each to the next one
    ring,     // the same, and the last to the first
    nearest,  // each to those that are nearest
    list,     // what a file lists
    fixed,    // each to a point of the arena
};

/// Where a body is linked.
enum class LinkAttachment {
    centre,
    rim,    // the point of its outline towards the other end
    place,  // LinkConfig::attach_mm
};

/// Which objects of the category are linked.
enum class LinkedObjects {
    all,
    rim,      // those that have fewer neighbours in their lattice than others
    numbers,  // LinkConfig::numbers
};

struct LinkConfig {
    std::string name;
    LinkKind kind = LinkKind::spring;
    std::vector<std::string> between;  // a category, or two
    LinkTopology topology = LinkTopology::chain;
    LinkedObjects which = LinkedObjects::all;
    std::vector<std::uint32_t> numbers;                                // of objects within the first category, from 0
    int neighbours = 6;                                                // nearest: so many of each object
    double max_distance_mm = std::numeric_limits<double>::infinity();  // nearest
    std::string file;                                                  // list, fixed
    std::filesystem::path found_file;                                  // the same, as it is opened
    std::optional<double> rest_length_mm{};                            // absent: the distance at the start
    float stiffness_n_m = 10.0F;                                       // spring
    float damping_n_s_m = 1.0F;                                        // spring
    std::optional<float> breaking_force_n{};                           // absent: never
    std::optional<Interval> limits_deg{};                              // hinge; absent: it turns freely
    LinkAttachment attach = LinkAttachment::centre;
    Vec2 attach_mm{};  // LinkAttachment::place: in the object's own frame
    bool visible = true;
    std::string line;  // where it is written, "conf/a.yaml:14", for messages

    bool has_two_categories() const { return between.size() == 2; }
    bool is_in_lattice() const { return topology == LinkTopology::triangular || topology == LinkTopology::square; }
};

}  // namespace pogosim
