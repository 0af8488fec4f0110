#include "config/lamp_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <vector>

#include "base/log.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

std::span<Key<Vec2> const> lighthouse_centre_keys() {
    using K = Key<Vec2>;
    static std::array const keys{
        K{"x", &Vec2::x, kCoordinate, "mm",
          "Centre; with `geometry` global or arena, relative to the centre of the arena's bounding box."},
        K{"y", &Vec2::y, kCoordinate, "mm", "See x."},
    };
    return keys;
}

void warn_of_lone_coordinate(MapReader const& reader, std::string_view x, std::string_view y, Vec2 centre_mm) {
    if (auto const lone = reader.lone_key(x, y)) {
        log().warn("{}: {}: {} without {}; {} is {:g}. Specify both", reader.find(lone->given)->where(),
                   reader.path_of(lone->given), lone->given, lone->missing, lone->missing,
                   lone->missing == y ? centre_mm.y : centre_mm.x);
    }
}

}  // namespace pogosim
