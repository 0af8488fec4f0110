#include "sim/broken_links.hpp"

#include <fmt/format.h>

#include <string>

#include "base/log.hpp"
#include "base/rounded_time.hpp"
#include "device/link_edit.hpp"

namespace pogosim {

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
