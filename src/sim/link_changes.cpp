#include "sim/link_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "base/escaped.hpp"
#include "base/log.hpp"
#include "base/rounded_time.hpp"
#include "device/link_edit.hpp"

namespace pogosim {

namespace {

std::string number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : "null";
}
std::string number(float value) {
    return std::isfinite(value) ? fmt::format("{}", value) : "null";
}
std::string pair(Vec2 point) {
    return fmt::format("[{},{}]", number(point.x), number(point.y));
}

char const* name_of(LinkKind kind) {
    switch (kind) {
        case LinkKind::spring:
            return "spring";
        case LinkKind::rod:
            return "rod";
        case LinkKind::hinge:
            break;
    }
    return "hinge";
}

/// `"name":[...]` of all values, each as text.
template <class Values, class Text>
std::string list(std::string_view name, Values const& values, Text const& text) {
    std::string all = fmt::format("\"{}\":[", name);
    char const* separator = "";
    for (auto const& value : values) {
        all += separator;
        all += text(value);
        separator = ",";
    }
    return all + ']';
}

/// The links from `first` on, without the last bracket.
std::string links_from(World const& world, std::size_t first) {
    std::span<Link const> const links = std::span(world.links).subspan(first);
    std::vector<std::uint32_t> const object_of = objects_of_bodies(world);
    // Only the objects that are linked, in the order of the run.
    std::vector<std::uint32_t> objects;
    for (Link const& link : links) {
        objects.push_back(object_of[link.a]);
        if (link.b != kNone) {
            objects.push_back(object_of[link.b]);
        }
    }
    std::ranges::sort(objects);
    objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
    auto const place = [&](std::uint32_t body) {
        return body == kNone ? -1 : std::ranges::lower_bound(objects, object_of[body]) - objects.begin();
    };

    std::string text = "{";
    text += list("objects", objects, [&](std::uint32_t i) {
        Object const& object = world.objects[i];
        return fmt::format("[{},{}]", json_text(world.categories[object.category].name), object.id);
    });
    text += ',' + list("categories", world.link_categories, [](LinkCategory const& category) {
                return fmt::format("{{\"name\":{},\"drawn\":{}}}", json_text(category.name), category.are_drawn);
            });
    auto const add = [&](char const* name, auto const& value) { text += ',' + list(name, links, value); };
    add("category", [](Link const& link) { return fmt::format("{}", link.link_category); });
    add("kind", [](Link const& link) { return fmt::format("\"{}\"", name_of(link.kind)); });
    add("a", [&](Link const& link) { return fmt::format("{}", place(link.a)); });
    add("b", [&](Link const& link) { return fmt::format("{}", place(link.b)); });
    add("end_a_mm", [](Link const& link) { return pair(link.end_a_mm); });
    add("end_b_mm", [](Link const& link) { return pair(link.end_b_mm); });
    add("rest_mm", [](Link const& link) { return number(link.length_mm); });
    add("stiffness_n_m", [](Link const& link) { return number(link.stiffness_n_m); });
    add("damping_n_s_m", [](Link const& link) { return number(link.damping_n_s_m); });
    add("breaking_n", [](Link const& link) { return number(link.breaking_n); });
    return text;
}

std::string second(double time_s) {
    return number(rounded_to_ns(time_s));
}

}  // namespace

std::string LinkRecord::initial(World const& world) {
    return world.links.empty() ? "" : links_from(world, 0) + '}';
}

void LinkRecord::follow(World const& world) {
    if (!has_begun_) {
        has_begun_ = true;
        initial_count_ = world.links.size();
    }
    made_s_.resize(std::max(world.links.size(), initial_count_) - initial_count_, world.time_s());
    is_cut_.resize(world.links.size());
    for (std::size_t i = 0; i < world.links.size(); ++i) {
        if (world.links[i].is_cut && !is_cut_[i]) {
            is_cut_[i] = true;
            cut_.push_back({.link = i, .time_s = world.time_s()});
        }
    }
}

std::string LinkRecord::changes(World const& world) const {
    if (made_s_.empty() && cut_.empty()) {
        return "";
    }
    std::string text = "{\"made\":";
    text += links_from(world, initial_count_) + ',' + list("time_s", made_s_, second) + '}';
    text += ",\"cut\":{" + list("link", cut_, [](Cut const& cut) { return fmt::format("{}", cut.link); });
    return text + ',' + list("time_s", cut_, [](Cut const& cut) { return second(cut.time_s); }) + "}}";
}

namespace {

std::string name_of(World const& world, std::uint32_t body) {
    std::uint32_t const index = object_of_body(world, body);
    if (index == kNone) {
        return "the arena";
    }
    Object const& object = world.objects[index];
    return fmt::format("object {} of '{}'", object.id, world.categories[object.category].name);
}

}  // namespace

void BrokenLinks::note(World const& world) {
    if (world.link_changes == changes_) {
        return;
    }
    changes_ = world.link_changes;
    is_cut_.clear();
    for (Link const& link : world.links) {
        is_cut_.push_back(link.is_cut);
    }
}

void BrokenLinks::tell(World const& world) {
    if (world.link_changes == changes_) {
        return;
    }
    has_broken_.resize(world.link_categories.size());
    is_cut_.resize(world.links.size());
    for (std::size_t i = 0; i < world.links.size(); ++i) {
        Link const& link = world.links[i];
        if (link.is_cut && !is_cut_[i] && !has_broken_[link.link_category]) {
            has_broken_[link.link_category] = true;
            log().info("links.{}: at {} s, the link from {} to {} has broken, the first of these",
                       world.link_categories[link.link_category].name, rounded_to_ns(world.time_s()),
                       name_of(world, link.a), name_of(world, link.b));
        }
    }
    note(world);
}

}  // namespace pogosim
