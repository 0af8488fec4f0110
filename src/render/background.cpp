#include "render/background.hpp"

#include <algorithm>
#include <cmath>

#include "render/between.hpp"
#include "render/blend.hpp"
#include "render/led_colour.hpp"
#include "render/scene.hpp"

namespace pogosim {

namespace {

constexpr float kWallWidth = 2.2F;  // of all lines here: in points, see Scene
constexpr float kProgrammedWallWidth = 1.8F;
constexpr float kWallGlowWidth = 16.0F;
constexpr float kWallGlowOpacity = 0.55F;

bool is_same_light(LightMap const* a, LightMap const* b) {
    if (a == b || a == nullptr || b == nullptr) {
        return a == b;
    }
    return a->columns == b->columns && a->rows == b->rows && a->level == b->level;
}

/// The box of pixels that lines along polygons touch.
PixelBox box_around(std::vector<Polygon> const& polygons_px, float width, PixelBox const& within) {
    Box box = bounding_box_of_all(polygons_px);
    box.min = box.min - Vec2{width, width};
    box.max = box.max + Vec2{width, width};
    return pixels_of(box, within);
}

}  // namespace

void Background::draw(Canvas& canvas, Camera const& camera, Snapshot const& snapshot, ThemeColours const& colours,
                      bool light_levels) {
    std::shared_ptr<LightMap const> const light = light_levels ? snapshot.light : nullptr;
    std::vector<Pixel> walls = wall_colours(snapshot, colours);
    bool const same_floor = is_as_before(canvas, camera, snapshot, colours);
    if (!same_floor) {
        scenery_ = nullptr;  // until it is drawn: there may be no memory for it
        draw_floor(canvas, camera, *snapshot.scenery, colours);
        scenery_ = snapshot.scenery;
        camera_ = camera;
        colours_ = colours;
    }
    bool const is_plain = !light && walls.empty();
    if (!is_plain && (!same_floor || !is_same_light(light.get(), light_.get()) || walls != wall_colours_)) {
        wall_colours_ = std::move(walls);
        picture_ = empty_;
        if (light) {
            draw_light(camera, *scenery_, *light, colours.lamplight);
        }
        draw_programmed_walls(camera, snapshot);
    }
    light_ = light;
    Canvas const& shown = is_plain ? empty_ : picture_;
    std::copy(shown.pixels().begin(), shown.pixels().end(), canvas.pixels().begin());
}

bool Background::is_as_before(Canvas const& canvas, Camera const& camera, Snapshot const& snapshot,
                              ThemeColours const& colours) const {
    return snapshot.scenery == scenery_ && camera == camera_ && colours == colours_ && canvas.size() == empty_.size();
}

void Background::draw_floor(Canvas const& canvas, Camera const& camera, Scenery const& scenery,
                            ThemeColours const& colours) {
    empty_.resize(canvas.size());
    empty_.fill(colours.paper);
    Snapshot const unused;
    Scene const scene{empty_, camera, unused, floor_, colours};
    std::vector<Polygon> polygons;
    for (Polygon const& polygon : scenery.arena.polygons) {
        polygons.push_back(scene.to_pixels(polygon));
        bool const is_clockwise = signed_area(polygon) > 0.0;
        bool const should_be = polygons.size() == 1;
        if (is_clockwise != should_be) {
            std::reverse(polygons.back().begin(), polygons.back().end());
        }
    }
    floor_.reset(empty_.bounds());
    floor_.add_polygons(polygons);
    empty_.cover(floor_, scene.colours.floor);

    scratch_.reset(empty_.bounds());
    for (Polygon const& polygon : polygons) {
        add_outline(scratch_, polygon, kWallWidth * scene.point_px());
    }
    empty_.cover(scratch_, scene.colours.wall);
    inside_.clear();
}

void Background::draw_light(Camera const& camera, Scenery const& scenery, LightMap const& light, Pixel lamplight) {
    std::size_t const cells = light.level.size();
    if (inside_.size() != cells) {
        inside_.resize(cells);
        std::size_t cell = 0;
        for (int row = 0; row < light.rows; ++row) {
            for (int column = 0; column < light.columns; ++column) {
                Vec2 const centre{light.origin_mm.x + (static_cast<float>(column) + 0.5F) * light.cell_mm.x,
                                  light.origin_mm.y + (static_cast<float>(row) + 0.5F) * light.cell_mm.y};
                inside_[cell++] = scenery.arena.contains(centre);
            }
        }
    }

    // Even light is not drawn.
    int darkest = 32767;
    int brightest = 0;
    for (std::size_t i = 0; i < cells; ++i) {
        if (inside_[i]) {
            darkest = std::min<int>(darkest, light.level[i]);
            brightest = std::max<int>(brightest, light.level[i]);
        }
    }
    if (brightest <= darkest) {
        return;
    }
    opacity_.resize(cells);
    std::transform(light.level.begin(), light.level.end(), opacity_.begin(), [&](int level) {
        float const share = static_cast<float>(level - darkest) / static_cast<float>(brightest);
        return palette::kBrightestLamplight * std::clamp(share, 0.0F, 1.0F);
    });

    PictureSize const size = picture_.size();
    std::vector<Between> columns(static_cast<std::size_t>(size.width_px));
    for (int x = 0; x < size.width_px; ++x) {
        float const mm = camera.to_mm({static_cast<float>(x) + 0.5F, 0.0F}, size).x;
        columns[static_cast<std::size_t>(x)] = between((mm - light.origin_mm.x) / light.cell_mm.x, light.columns);
    }
    auto pixel = picture_.pixels().begin();
    for (int y = 0; y < size.height_px; ++y) {
        float const mm = camera.to_mm({0.0F, static_cast<float>(y) + 0.5F}, size).y;
        Between const row = between((mm - light.origin_mm.y) / light.cell_mm.y, light.rows);
        float const* const above = opacity_.data() + row.low * static_cast<std::size_t>(light.columns);
        float const* const below = opacity_.data() + row.high * static_cast<std::size_t>(light.columns);
        std::uint8_t const* const floor = floor_.row(y);
        for (std::size_t x = 0; x < columns.size(); ++x, ++pixel) {
            Between const& column = columns[x];
            float const left = above[column.low] + row.share * (below[column.low] - above[column.low]);
            float const right = above[column.high] + row.share * (below[column.high] - above[column.high]);
            float const opacity = left + column.share * (right - left);
            blend(*pixel, lamplight, opacity * static_cast<float>(floor[x]), 256.0F / 255.0F);
        }
    }
}

void Background::draw_programmed_walls(Camera const& camera, Snapshot const& snapshot) {
    Scene const scene{picture_, camera, snapshot, floor_, colours_};
    for (std::size_t i = 0; i < wall_colours_.size(); ++i) {
        std::vector<Polygon> polygons;
        for (Polygon const& polygon : snapshot.scenery->outlines[i].polygons) {
            polygons.push_back(scene.to_pixels(polygon));
        }
        if (polygons.empty()) {
            continue;
        }
        float const glow_width = kWallGlowWidth * scene.point_px();
        PixelBox const box = box_around(polygons, glow_width, picture_.bounds());
        scratch_.reset(box);
        for (Polygon const& polygon : polygons) {
            for (std::size_t k = 0; k < polygon.size(); ++k) {
                scratch_.add_glow(polygon[k], polygon[k + 1 == polygon.size() ? 0 : k + 1], glow_width);
            }
        }
        scratch_.keep_within(floor_);
        picture_.cover(scratch_, with_opacity(wall_colours_[i], kWallGlowOpacity));
        scratch_.reset(box);
        for (Polygon const& polygon : polygons) {
            add_outline(scratch_, polygon, kProgrammedWallWidth * scene.point_px());
        }
        picture_.cover(scratch_, wall_colours_[i]);
    }
}

std::vector<Pixel> Background::wall_colours(Snapshot const& snapshot, ThemeColours const& colours) const {
    std::vector<Pixel> walls;
    for (Outline const& outline : snapshot.scenery->outlines) {
        walls.push_back(shown_colour(snapshot, colours, snapshot.led[outline.robot][0], colours.dark_wall));
    }
    return walls;
}

}  // namespace pogosim
