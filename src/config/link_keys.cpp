#include "config/scenario_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "config/find_file.hpp"
#include "config/reading.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kBetween = "a category of objects, or a list of two";
constexpr std::string_view kWhich = "all, rim, or a list of numbers from 0";
constexpr std::string_view kAttach = "center, rim, or a list [x, y] of numbers (mm)";

constexpr Range kForce = above(0).up_to(1e9);

bool is_spring(LinkConfig const& link) {
    return link.kind == LinkKind::spring;
}

/// What says where the ends of a hinge are: the middle between both bodies, the place in a file, or where it is
/// attached.
bool has_attachment(LinkConfig const& link) {
    return link.kind != LinkKind::hinge || (link.topology == LinkTopology::fixed && link.file.empty());
}

std::span<Key<LinkConfig> const> link_keys() {
    using K = Key<LinkConfig>;
    constexpr bool required = true;
    constexpr auto is_nearest = [](LinkConfig const& link) { return link.topology == LinkTopology::nearest; };
    constexpr auto has_file = [](LinkConfig const& link) {
        return link.topology == LinkTopology::list || link.topology == LinkTopology::fixed;
    };
    constexpr auto is_hinge = [](LinkConfig const& link) { return link.kind == LinkKind::hinge; };
    constexpr auto has_length = [](LinkConfig const& link) { return link.kind != LinkKind::hinge; };
    static std::array const keys{
        K{"type",
          one_of(&LinkConfig::kind, {{"spring", LinkKind::spring}, {"rod", LinkKind::rod}, {"hinge", LinkKind::hinge}}),
          any(), "",
          "spring: pulls or pushes along the line between its ends. rod: keeps their distance. hinge: the bodies turn "
          "about one point of both, the middle between their centres at the start."},
        K{"between", Elsewhere{kBetween}, any(), "",
          "Category whose objects are linked with each other; of two, each link is from the first one to the second. "
          "Robots and passive objects of one body each.",
          required},
        K{"topology",
          one_of(&LinkConfig::topology, {{"triangular", LinkTopology::triangular},
                                         {"square", LinkTopology::square},
                                         {"chain", LinkTopology::chain},
                                         {"ring", LinkTopology::ring},
                                         {"nearest", LinkTopology::nearest},
                                         {"list", LinkTopology::list},
                                         {"fixed", LinkTopology::fixed}}),
          any(), "",
          "triangular, square: neighbours in the lattice of that kind in which initial_formation placed them. chain: "
          "each object to the next one, in the order of their numbers. ring: the same, and the last to the first. "
          "nearest: each to those nearest to it. list: the pairs in a file. fixed: each to a point of the arena.",
          required},
        K{"neighbors", &LinkConfig::neighbours, between(1, 1000), "",
          "nearest: how many each object is linked to; pairs that choose each other get one link."}
            .only_if(is_nearest),
        K{"neighbours", &LinkConfig::neighbours, between(1, 1000), "", "The same."}
            .only_if(is_nearest)
            .other_name_of("neighbors"),
        K{"max_distance", &LinkConfig::max_distance_mm, kLength.or_infinity(), "mm",
          "nearest: objects further apart, from centre to centre, are not linked."}
            .only_if(is_nearest),
        K{"file", &LinkConfig::file, any(), "",
          "list: CSV file with columns a, b and optionally length (mm). fixed: with columns a, x, y (mm); without a "
          "file, each object is held where it is at the start. a and b are numbers of objects within their category, "
          "from 0. Searched like arena_file."}
            .only_if(has_file),
        K{"which", Elsewhere{kWhich}, any(), "",
          "Objects of the first category that are linked, by their number within it; chain and ring follow the order "
          "of the list. rim: those of a lattice with fewer neighbours than inside; fixed only."}
            .only_if([](LinkConfig const& link) {
                return link.topology != LinkTopology::list &&
                       (link.topology != LinkTopology::fixed || link.file.empty());
            }),
        K{"rest_length", NumberOr<LinkConfig>{&LinkConfig::rest_length_mm, "initial"}, between(0, kMaxLength), "mm",
          "Length without tension, between the points of attachment. initial: the distance at the start."}
            .only_if(has_length),
        K{"stiffness", &LinkConfig::stiffness_n_m, above(0).up_to(1e9), "N/m",
          "Force per change of length. Two masses m1, m2 (kg) on a spring of stiffness k oscillate at sqrt(k (1/m1 + "
          "1/m2)) / (2 pi) Hz; a disk of radius r (mm) has pi r^2 / 10000 times body_density, a Pogobot 2.2 kg."}
            .only_if(is_spring),
        K{"damping", &LinkConfig::damping_n_s_m, between(0, 1e9), "N s/m",
          "Force per speed at which the length changes; 2 sqrt(k m1 m2 / (m1 + m2)) is critical."}
            .only_if(is_spring),
        K{"breaking_force", &LinkConfig::breaking_force_n, kForce, "N",
          "A link with a larger force is cut, for the rest of the run; default: never."},
        K{"limits", &LinkConfig::limits_deg, between(-180, 180), "degrees",
          "How far the second body may turn against the first, clockwise on the screen, from the angle at the start; "
          "default: freely."}
            .only_if(is_hinge),
        K{"attach", Elsewhere{kAttach}, any(), "",
          "Where bodies are linked. center: they turn freely. rim: at the point of the outline towards the other end, "
          "so the link turns them. [x, y]: in the object's own frame, x ahead, y to its right."}
            .only_if(has_attachment),
        K{"visible", &LinkConfig::visible, any(), "", "Draw these links."},
    };
    return keys;
}

std::vector<std::string> read_between(Place const& place) {
    std::vector<std::string> names;
    if (place.node.kind == Node::Kind::scalar) {
        names.push_back(place.node.scalar);
    } else if (place.node.kind == Node::Kind::sequence) {
        for (Node const& item : place.node.items) {
            if (item.kind != Node::Kind::scalar) {
                fail_expected(place, kBetween);
            }
            names.push_back(item.scalar);
        }
    }
    if (names.empty() || names.size() > 2) {
        fail_expected(place, kBetween);
    }
    if (names.size() == 2 && names[0] == names[1]) {
        names.pop_back();
    }
    return names;
}

void read_which(Place const& place, LinkConfig& link) {
    Node const& node = place.node;
    if (node.kind == Node::Kind::scalar && (node.scalar == "all" || node.scalar == "rim")) {
        link.which = node.scalar == "all" ? LinkedObjects::all : LinkedObjects::rim;
        return;
    }
    if (node.kind != Node::Kind::sequence || node.items.empty()) {
        fail_expected(place, kWhich);
    }
    link.which = LinkedObjects::numbers;
    std::set<std::uint32_t> seen;
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        Place const item{node.items[i], fmt::format("{}.{}", place.path, i)};
        int number = 0;
        require_integers(item);
        read_value(item, {between(0, kMaxObjects)}, number);
        link.numbers.push_back(static_cast<std::uint32_t>(number));
        if (!seen.insert(link.numbers.back()).second) {
            fail_at(place, fmt::format("the number {} stands twice", number));
        }
    }
}

void read_attach(Place const& place, LinkConfig& link) {
    Node const& node = place.node;
    if (node.kind == Node::Kind::scalar && (node.scalar == "center" || node.scalar == "centre")) {
        link.attach = LinkAttachment::centre;
    } else if (node.kind == Node::Kind::scalar && node.scalar == "rim") {
        link.attach = LinkAttachment::rim;
    } else if (node.kind == Node::Kind::sequence) {
        link.attach = LinkAttachment::place;
        read_value(place, {kCoordinate, "mm"}, link.attach_mm);
    } else {
        fail_expected(place, kAttach);
    }
}

void check_limits(MapReader const& reader, LinkConfig const& link) {
    if (link.kind == LinkKind::hinge && link.limits_deg && (link.limits_deg->min > 0.0 || link.limits_deg->max < 0.0)) {
        reader.refuse("limits", fmt::format("expected two angles with 0, the angle at the start, between them, found "
                                            "[{}, {}]",
                                            number_text(link.limits_deg->min), number_text(link.limits_deg->max)));
    }
}

void find_file_of(MapReader const& reader, LinkConfig& link) {
    bool const is_list = link.topology == LinkTopology::list;
    Node const* const node = reader.find("file");
    if (is_list && link.file.empty()) {
        fail_at(
            node != nullptr ? Place{*node, reader.path_of("file")} : Place{reader.place().node, reader.path_of("file")},
            "expected the name of a CSV file with columns a and b; 'topology: list' needs it");
    }
    if (node == nullptr || link.file.empty() || (!is_list && link.topology != LinkTopology::fixed)) {
        return;
    }
    link.found_file = find_file({*node, reader.path_of("file")}, reader.reading().configuration, "a CSV file");
    reader.reading().object_files.push_back({link.found_file, "the list of links"});
}

/// Keys that are there, and mean nothing for this type and topology.
void warn_of_unused(MapReader const& reader, LinkConfig const& link, std::string_view type, std::string_view topology) {
    std::vector<std::string_view> unused;
    for (Key<LinkConfig> const& key : link_keys()) {
        if (!key.has_effect(link) && reader.find(key.name) != nullptr) {
            unused.push_back(key.name);
        }
    }
    if (!unused.empty()) {
        log().warn("{}: {}: {} {} no effect with type {} and topology {}", reader.find(unused.front())->where(),
                   shown(reader.place().path), fmt::join(unused, ", "), unused.size() == 1 ? "has" : "have", type,
                   topology);
    }
}

std::string name_of(MapReader const& reader, std::string_view key) {
    Node const* const value = reader.values().find(key);
    return value == nullptr ? "" : value->scalar;
}

/// An entry without `between` that a `--set` with a slip in its name makes.
void refuse_slip_of_set(Node const& links, std::string const& name, Node const& node) {
    if (node.source != kSetSource || node.kind != Node::Kind::map || node.find("between") != nullptr) {
        return;
    }
    std::vector<std::string> others;
    for (auto const& [other, value] : links.entries) {
        if (value.source != kSetSource || value.find("between") != nullptr) {
            others.push_back(other);
        }
    }
    fail_at({node, "links"}, fmt::format("unknown links '{}'{}{}", shown(name),
                                         others.empty() ? "" : fmt::format(" (known: {})", fmt::join(others, ", ")),
                                         did_you_mean(shown(name), others)));
}

Node read_link(Place const& place, std::string const& name, Reading& reading, LinkConfig& link) {
    link.name = name;
    link.line = place.node.where();
    MapReader reader(place.node, place.path, reading);
    std::size_t const before = reading.problems.messages().size();
    reader.read(link_keys(), link);
    auto const read_part = [&](std::string_view key, auto const& read) {
        if (Node const* const node = reader.find(key)) {
            reader.collect([&] { read({*node, reader.path_of(key)}); });
        }
    };
    read_part("between", [&](Place const& at) { link.between = read_between(at); });
    read_part("which", [&](Place const& at) { read_which(at, link); });
    read_part("attach", [&](Place const& at) { read_attach(at, link); });
    check_limits(reader, link);
    reader.collect([&] { find_file_of(reader, link); });
    reader.finish();
    if (reading.problems.messages().size() == before) {
        warn_of_unused(reader, link, name_of(reader, "type"), name_of(reader, "topology"));
    }
    return reader.values();
}

}  // namespace

Node read_links(MapReader const& top, std::vector<LinkConfig>& links) {
    Node values;
    values.kind = Node::Kind::map;
    Node const* const map = top.find("links");
    if (map == nullptr) {
        return {};
    }
    if (map->kind != Node::Kind::map) {
        fail_expected({*map, "links"}, kLinksMap);
    }
    for (auto const& [name, node] : map->entries) {
        top.collect([&, &name = name, &node = node] {
            refuse_slip_of_set(*map, name, node);
            LinkConfig link;
            std::size_t const before = top.reading().problems.messages().size();
            values.entries.emplace_back(name, read_link({node, "links." + name}, name, top.reading(), link));
            if (top.reading().problems.messages().size() == before) {
                links.push_back(std::move(link));
            }
        });
    }
    return values;
}

std::vector<KeyDescription> link_keys_reference() {
    return described(link_keys());
}

}  // namespace pogosim
