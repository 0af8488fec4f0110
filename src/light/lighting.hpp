// Keeps the light map of the world up to date.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "light/lamp.hpp"
#include "light/light_blockers.hpp"
#include "world/specs.hpp"
#include "world/world.hpp"

namespace pogosim {

/// A dark map of the given number of cells over the arena's bounding box, which may be periodic: then, each place gets
/// the light of the nearest image of each lamp.
LightMap make_light_map(Arena const& arena, bool periodic, int columns, int rows);

/// All lamps of a run. Can be copied. A step costs what changes: the cells that moving lamps light before and after it.
class Lighting {
public:
    /// Only the arena and the cells of the map are read from the world. Lamp i has the setting world.lamps[i], or the
    /// usual one where there is none.
    Lighting(std::vector<LampSpec> const& lamps, World const& world);

    /// Writes world.light for the present time and the settings of the lamps.
    void update(World& world);

    /// The next update() writes all of the map, which has become another one.
    void forget_map() { is_first_update_ = true; }

    /// Where the lamps stand, and their beams, at the last update.
    std::vector<LampMark> marks() const;

private:
    /// A lamp, and the part of its light that is on the map.
    struct Entry {
        LampSpec spec;  // of the configuration
        std::size_t number = 0;
        std::shared_ptr<Lamp const> lamp;
        LampState shown{};
        LampSetting setting{};
        std::vector<std::uint32_t> hidden{};           // cells in shadow
        std::vector<std::uint32_t> hidden_by_walls{};  // the same of walls alone
        Vec2 hidden_from_mm{};
    };

    static bool take_over(Entry& entry, World const& world);
    bool cast_shadows(Entry& entry, World const& world, bool has_blocker_moved);
    void paint(Entry const& entry, LightMap& map);
    void sum_still_lamps(LightMap& map, bool has_plain_changed);
    void paint_still_lamps(LightMap& map, bool with_shadows);

    std::vector<Entry> lamps_;            // in the order in which they are put on the map
    std::vector<std::int16_t> plain_;     // levels of those that stand still and cast no shadows, if others do
    std::vector<std::int16_t> base_;      // levels of the lamps that stand still alone
    std::vector<std::uint32_t> painted_;  // cells where the map may differ from that
    bool is_first_update_ = true;
    bool casts_shadows_ = false;  // any of them
    LightBlockers blockers_;
    std::vector<std::uint32_t> newly_hidden_;  // space for cast_shadows()
    std::vector<std::int16_t> kept_levels_;    // space for paint()
};

}  // namespace pogosim
