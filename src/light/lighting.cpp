#include "light/lighting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "base/memory.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kCellBytes = sizeof(std::int16_t);

std::string cells_text(LightMap const& map) {
    return fmt::format("{} x {} cells", map.columns, map.rows);
}

std::shared_ptr<Lamp const> make_lamp(LampSpec const& spec, LampSetting const& setting, World const& world) {
    return spec.make(setting.moved_mm, setting.intensity, world.arena, world.light);
}

}  // namespace

LightMap make_light_map(Arena const& arena, bool periodic, int columns, int rows) {
    Vec2 const size = arena.bounds.size();
    LightMap map{.columns = columns,
                 .rows = rows,
                 .origin_mm = arena.bounds.min,
                 .cell_mm = {size.x / static_cast<float>(columns), size.y / static_cast<float>(rows)},
                 .periodic = periodic,
                 .level = {}};
    auto const cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    allocate_for([&] { return fmt::format("the light map: {} of {} bytes", cells_text(map), kCellBytes); },
                 static_cast<double>(cells * kCellBytes), [&] { map.level.assign(cells, 0); });
    return map;
}

Lighting::Lighting(std::vector<LampSpec> const& lamps, World const& world) {
    for (LampSpec const& spec : lamps) {
        auto const add = [&] {
            lamps_.push_back({.spec = spec, .number = lamps_.size(), .lamp = make_lamp(spec, {}, world)});
        };
        auto const purpose = [&] {
            return fmt::format("the cells that lamp {} of {} lights, of the {} of the light map", lamps_.size() + 1,
                               lamps.size(), cells_text(world.light));
        };
        allocate_for(purpose, std::nullopt, add);
    }
    std::ranges::stable_sort(lamps_, {}, [](Entry const& entry) { return entry.lamp->layer(); });
}

/// Returns whether the setting of the lamp is a new one.
bool Lighting::take_over(Entry& entry, World const& world) {
    LampSetting const setting = entry.number < world.lamps.size() ? world.lamps[entry.number].setting : LampSetting();
    if (setting == entry.setting) {
        return false;
    }
    if (setting.intensity != entry.setting.intensity || setting.moved_mm != entry.setting.moved_mm) {
        entry.lamp = make_lamp(entry.spec, setting, world);
    }
    entry.setting = setting;
    return true;
}

void Lighting::update(World& world) {
    // What has changed?
    bool any_changed = is_first_update_;
    bool base_changed = is_first_update_;
    for (Entry& entry : lamps_) {
        bool const is_set = take_over(entry, world);
        LampState const state = entry.lamp->state_at(world.time_s());
        if (state != entry.shown || is_set) {
            entry.shown = state;
            any_changed = true;
            base_changed = base_changed || entry.lamp->layer() == Layer::still;
        }
    }
    is_first_update_ = false;
    if (!any_changed) {
        return;
    }

    // Take the moving lamps off the map.
    LightMap& map = world.light;
    if (base_changed) {
        sum_still_lamps(map);
    } else {
        for (std::uint32_t const cell : painted_) {
            map.level[cell] = base_[cell];
        }
    }

    // Put them on again, where they are now.
    painted_.clear();
    for (Entry const& entry : lamps_) {
        if (entry.lamp->layer() != Layer::still && entry.setting.is_on) {
            entry.lamp->paint(entry.shown, map, painted_);
        }
    }
}

std::vector<LampMark> Lighting::marks() const {
    std::vector<LampMark> marks;
    for (Entry const& entry : lamps_) {
        std::size_t const before = marks.size();
        entry.lamp->mark(entry.shown, marks);
        for (std::size_t i = before; i < marks.size() && !entry.setting.is_on; ++i) {
            marks[i].beam_is_on = false;
        }
    }
    return marks;
}

void Lighting::sum_still_lamps(LightMap& map) {
    std::ranges::fill(map.level, std::int16_t{0});
    for (Entry const& entry : lamps_) {
        if (entry.lamp->layer() == Layer::still && entry.setting.is_on) {
            entry.lamp->paint(entry.shown, map, painted_);
        }
    }
    auto const purpose = [&] {
        return fmt::format("the light of the lamps that stand still: {} of {} bytes", cells_text(map), kCellBytes);
    };
    allocate_for(purpose, static_cast<double>(map.level.size() * kCellBytes), [&] { base_ = map.level; });
}

}  // namespace pogosim
