#include "sim/object_facts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "base/escaped.hpp"
#include "sim/build_world.hpp"
#include "sim/make_membrane.hpp"

namespace pogosim {

namespace {

struct Ids {
    std::uint32_t first = 0;  // ids of an entry follow each other
    std::size_t count = 0;
};

/// By category of the world.
std::vector<Ids> ids_by_category(World const& world) {
    std::vector<Ids> ids(world.categories.size());
    for (Object const& object : world.objects) {
        Ids& own = ids[object.category];
        own.first = own.count == 0 ? object.id : std::min(own.first, object.id);
        own.count += 1;
    }
    return ids;
}

char const* name_of(DrawnAs drawn_as) {
    switch (drawn_as) {
        case DrawnAs::spot:
            return "spot";
        case DrawnAs::beam:
            return "beam";
        case DrawnAs::nothing:
            break;
    }
    return "nothing";
}

std::string has_text(ObjectSpec const& spec) {
    bool const has_motors = spec.robot && spec.robot->model.has_motors();
    std::vector<std::string_view> names;
    for (auto const& [has, name] : {std::pair(spec.body.has_value(), "body"),
                                    {spec.membrane.has_value(), "membrane"},
                                    {spec.robot.has_value(), "robot"},
                                    {has_motors, "motors"},
                                    {spec.lamp.has_value(), "lamp"}}) {
        if (has) {
            names.emplace_back(name);
        }
    }
    return fmt::format("[\"{}\"]", fmt::join(names, "\",\""));
}

std::string entry_text(ObjectConfig const& object, Ids ids) {
    ObjectSpec const& spec = object.spec;
    std::string text = fmt::format("{{\"type\":{},\"has\":{}", json_text(object.type), has_text(spec));
    text += fmt::format(",\"count\":{}", spec.lamp ? static_cast<std::size_t>(object.nb) : ids.count);
    if (ids.count > 0) {
        text += fmt::format(",\"first_id\":{}", ids.first);
    }
    if (spec.robot) {
        text += fmt::format(",\"infrared_range_mm\":{}", spec.robot->ir.range_mm);
        if (spec.robot->model.has_motors()) {
            text += fmt::format(",\"top_speed_mm_s\":{}", spec.robot->max_linear_speed_mm_s);
        }
    }
    if (spec.membrane) {
        text += fmt::format(",\"half_thickness_mm\":{},\"segments\":{}", half_thickness_mm(*spec.membrane),
                            spec.membrane->segments);
    }
    if (!spec.body && object.position_mm) {
        text += fmt::format(",\"position_mm\":[{},{}]", object.position_mm->x, object.position_mm->y);
    }
    if (spec.lamp) {
        text += fmt::format(",\"drawn_as\":\"{}\"", name_of(object.drawn_as));
    }
    return text + '}';
}

}  // namespace

std::string object_facts(Scenario const& scenario, World const& world) {
    std::vector<Ids> const ids = ids_by_category(world);
    std::size_t next = 0;  // category of the world
    std::vector<std::pair<std::string, std::vector<std::string>>> entries_by_name;
    for (ObjectConfig const& object : scenario.objects) {
        Ids const own = is_created(object, world.periodic) ? ids[next++] : Ids();
        auto named = std::ranges::find(entries_by_name, object.category, [](auto const& pair) { return pair.first; });
        if (named == entries_by_name.end()) {
            named = entries_by_name.insert(named, {object.category, {}});
        }
        named->second.push_back(entry_text(object, own));
    }
    std::vector<std::string> categories;
    for (auto const& [name, entries] : entries_by_name) {
        categories.push_back(fmt::format("{}:[{}]", json_text(name), fmt::join(entries, ",")));
    }
    return fmt::format("{{{}}}", fmt::join(categories, ","));
}

}  // namespace pogosim
