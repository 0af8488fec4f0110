#include "config/lamp_keys.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "base/log.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

namespace {

std::span<Key<LampSpec> const> lamp_keys() {
    using K = Key<LampSpec>;
    static std::array const keys{
        K{"casts_shadows", &LampSpec::casts_shadows, any(), "",
          "Walls and bodies hide the lamp from the cells of the light map behind them; see `walls_block_light` and "
          "`blocks_light`. Not for light without a place: `geometry` global or arena, unless it is a gradient, and "
          "planes."}
            .left_out_at_default<&LampSpec::casts_shadows, false>(),
    };
    return keys;
}

std::span<Key<Vec2> const> lighthouse_centre_keys() {
    using K = Key<Vec2>;
    static std::array const keys{
        K{"x", &Vec2::x, kCoordinate, "mm",
          "Centre; with `geometry` global or arena, relative to the centre of the arena's bounding box."},
        K{"y", &Vec2::y, kCoordinate, "mm", "See x."},
    };
    return keys;
}

}  // namespace

void make_lamp_object(MapReader& reader, ObjectConfig& object, LampSpec lamp, bool has_place) {
    reader.read(lamp_keys(), lamp);
    if (lamp.casts_shadows && !has_place) {
        reader.refuse("casts_shadows",
                      "this light comes from no place, so nothing can be in its way; use a lamp with a place, such as "
                      "light_mode gradient, or geometry disk");
    }
    object.spec.lamp = std::move(lamp);
}

void warn_of_lone_coordinate(MapReader const& reader, std::string_view x, std::string_view y, Vec2 centre_mm) {
    if (auto const lone = reader.lone_key(x, y)) {
        log().warn("{}: {}: {} without {}; {} is {:g}. Specify both", reader.find(lone->given)->where(),
                   reader.path_of(lone->given), lone->given, lone->missing, lone->missing,
                   lone->missing == y ? centre_mm.y : centre_mm.x);
    }
}

void read_lighthouse_place(MapReader& reader, Shape& shape, Vec2& centre_mm) {
    read_shape(reader, any_geometry_keys(), shape);
    reader.read(lighthouse_centre_keys(), centre_mm);
    if (!is_everywhere(shape)) {
        warn_of_lone_coordinate(reader, "x", "y", centre_mm);
    }
}

}  // namespace pogosim
