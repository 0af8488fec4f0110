#include "light/lighting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

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
        casts_shadows_ = casts_shadows_ || spec.casts_shadows;
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

/// Returns whether other cells are hidden from the lamp than before.
bool Lighting::cast_shadows(Entry& entry, World const& world, bool has_blocker_moved) {
    Vec2 const source_mm = entry.lamp->source_mm(entry.shown);
    bool const has_moved = is_first_update_ || source_mm != entry.hidden_from_mm;
    if (!has_blocker_moved && !has_moved) {
        return false;
    }
    entry.hidden_from_mm = source_mm;
    if (has_moved) {
        blockers_.find_hidden_by_walls(world, source_mm, entry.hidden_by_walls);
    }
    newly_hidden_ = entry.hidden_by_walls;
    blockers_.add_hidden_by_bodies(world, source_mm, newly_hidden_);
    std::swap(entry.hidden, newly_hidden_);
    return entry.hidden != newly_hidden_;
}

/// Puts a lamp on the map; the cells that are hidden from it keep their levels.
void Lighting::paint(Entry const& entry, LightMap& map) {
    kept_levels_.clear();
    for (std::uint32_t const cell : entry.hidden) {
        kept_levels_.push_back(map.level[cell]);
    }
    entry.lamp->paint(entry.shown, map, painted_);
    for (std::size_t i = 0; i < entry.hidden.size(); ++i) {
        map.level[entry.hidden[i]] = kept_levels_[i];
    }
}

void Lighting::update(World& world) {
    // What has changed?
    bool any_changed = is_first_update_;
    bool base_changed = is_first_update_;
    bool has_plain_changed = is_first_update_;
    bool const has_blocker_moved = casts_shadows_ && blockers_.update(world);
    for (Entry& entry : lamps_) {
        bool const is_set = take_over(entry, world);
        LampState const state = entry.lamp->state_at(world.time_s());
        bool const is_new = state != entry.shown || is_set;
        entry.shown = state;
        if ((entry.spec.casts_shadows && cast_shadows(entry, world, has_blocker_moved)) || is_new) {
            any_changed = true;
            bool const is_still = entry.lamp->layer() == Layer::still;
            base_changed = base_changed || is_still;
            has_plain_changed = has_plain_changed || (is_still && !entry.spec.casts_shadows);
        }
    }
    is_first_update_ = false;
    if (!any_changed) {
        return;
    }

    // Take the moving lamps off the map.
    LightMap& map = world.light;
    if (base_changed) {
        sum_still_lamps(map, has_plain_changed);
    } else {
        for (std::uint32_t const cell : painted_) {
            map.level[cell] = base_[cell];
        }
    }

    // Put them on again, where they are now.
    painted_.clear();
    for (Entry const& entry : lamps_) {
        if (entry.lamp->layer() != Layer::still && entry.setting.is_on) {
            paint(entry, map);
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

void Lighting::paint_still_lamps(LightMap& map, bool with_shadows) {
    for (Entry const& entry : lamps_) {
        if (entry.lamp->layer() == Layer::still && entry.setting.is_on && entry.spec.casts_shadows == with_shadows) {
            paint(entry, map);
        }
    }
}

/// Light adds up, so lamps without shadows can come first, and stay while shadows move.
void Lighting::sum_still_lamps(LightMap& map, bool has_plain_changed) {
    auto const keep = [&](std::vector<std::int16_t>& levels) {
        auto const purpose = [&] {
            return fmt::format("the light of the lamps that stand still: {} of {} bytes", cells_text(map), kCellBytes);
        };
        allocate_for(purpose, static_cast<double>(map.level.size() * kCellBytes), [&] { levels = map.level; });
    };
    if (has_plain_changed) {
        std::ranges::fill(map.level, std::int16_t{0});
        paint_still_lamps(map, /*with_shadows=*/false);
        if (casts_shadows_) {
            keep(plain_);
        }
    } else {
        map.level = plain_;
    }
    paint_still_lamps(map, /*with_shadows=*/true);
    keep(base_);
}

}  // namespace pogosim
