#include "device/world_edit.hpp"

namespace pogosim {

bool WorldEdit::set_pose(World& world, Object const& object, Vec2 centre_mm, float heading_rad) {
    if (object.body == kNone || !is_free(object, centre_mm)) {
        return false;
    }
    pogosim::set_pose(world, object, centre_mm, heading_rad);
    light_is_stale = true;  // it may throw a shadow
    return true;
}

void WorldEdit::set_lamp(World& world, std::size_t lamp, LampSetting const& setting) {
    world.lamps[lamp].setting = setting;
    light_is_stale = true;
}

void WorldEdit::settle_light() {
    if (light_is_stale) {
        light_is_stale = false;
        update_light();
    }
}

LampSetting moved_to(PlacedLamp const& lamp, Vec2 place_mm) {
    LampSetting setting = lamp.setting;
    if (place_mm != lamp.place_mm()) {  // else the displacement keeps its digits
        setting.moved_mm = place_mm - lamp.start_mm;
    }
    return setting;
}

}  // namespace pogosim
