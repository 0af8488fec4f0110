// pogosim/painter.h: pictures of recorded runs.
#include "pogosim/painter.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "host/link_kind.hpp"
#include "host/pixels.hpp"
#include "host/recorded_stage.hpp"
#include "host/status.hpp"
#include "render/infrared_ends.hpp"
#include "render/painter.hpp"
#include "sim/robot_values.hpp"

using namespace pogosim;

/// As declared in pogosim/painter.h.
struct pogosim_painter {
    RecordedStage stage;
    Painter painter;
    Canvas canvas{{0, 0}};
    std::shared_ptr<LightMap const> light;  // of the last picture
};

namespace {

Vec2 point(float const* mm) {
    return {mm[0], mm[1]};
}

Rgb colour_of(std::uint32_t rgb) {
    return {static_cast<std::uint8_t>(rgb >> 16U), static_cast<std::uint8_t>(rgb >> 8U),
            static_cast<std::uint8_t>(rgb)};
}

void copy_bodies(Scenery const& scenery, pogosim_moment const& moment, Snapshot& snapshot) {
    std::size_t const bodies = scenery.body_shape.size();
    snapshot.position_mm.reserve(bodies);
    snapshot.heading_rad.reserve(bodies);
    float const* part_mm = moment.parts_mm;
    float const* pose = moment.poses;
    for (Object const& object : scenery.objects) {
        if (object.body_count == 1) {
            snapshot.position_mm.push_back(point(pose));
            snapshot.heading_rad.push_back(pose[2]);
        } else {
            for (std::uint32_t i = 0; i < object.body_count; ++i, part_mm += 2) {
                snapshot.position_mm.push_back(point(part_mm));
                snapshot.heading_rad.push_back(0.0F);
            }
        }
        pose += 3;
    }
}

void copy_colours(RecordedStage const& stage, std::uint32_t const* rgb, Snapshot& snapshot) {
    for (Object const& object : stage.scenery->objects) {
        Rgb const colour = colour_of(*rgb++);
        if (object.robot != kNone) {
            snapshot.led.push_back({colour});
        }
        if (!stage.shows_leds) {
            snapshot.shown_rgb.push_back(colour);
        }
    }
}

void copy_velocities(Scenery const& scenery, float const* velocity_mm_s, Snapshot& snapshot) {
    for (Object const& object : scenery.objects) {
        if (object.body_count == 1) {
            snapshot.velocity_mm_s.push_back(point(velocity_mm_s));
        } else {
            snapshot.velocity_mm_s.resize(snapshot.velocity_mm_s.size() + object.body_count);
        }
        velocity_mm_s += 2;
    }
}

RobotColumn heat_of(RecordedStage const& stage, pogosim_moment const& moment) {
    ValueInfo const known = value_info(stage.view.heat_map);
    RobotColumn heat{.name = stage.view.heat_map,
                     .unit = std::string(known.unit),
                     .is_angle = known.is_angle,
                     .values = {},
                     .low = moment.heat_low,
                     .high = moment.heat_high};
    for (std::size_t i = 0; i < stage.scenery->objects.size(); ++i) {
        if (stage.scenery->objects[i].robot != kNone) {
            heat.values.push_back(moment.heat[i]);
        }
    }
    return heat;
}

std::shared_ptr<Trails const> trails_of(Scenery const& scenery, pogosim_moment const& moment) {
    std::vector<TrailPoint> points;
    std::vector<std::uint32_t> counts;
    std::size_t next = 0;
    for (std::size_t i = 0; i < scenery.objects.size(); ++i) {
        std::size_t const end = next + moment.trail_counts[i];
        if (scenery.objects[i].robot != kNone) {
            bool const is_rigid = scenery.objects[i].body_count == 1;
            counts.push_back(is_rigid ? moment.trail_counts[i] : 0);
            for (std::size_t k = next; is_rigid && k < end; ++k) {
                points.push_back({point(moment.trail_mm + 2 * k), colour_of(moment.trail_rgb[k])});
            }
        }
        next = end;
    }
    auto trails = std::make_shared<Trails>();
    trails->take(points, counts, moment.trail_fading);
    return trails;
}

std::shared_ptr<LightMap const> light_of(RecordedStage const& stage, std::int16_t const* levels) {
    auto light = std::make_shared<LightMap>();
    Box const& bounds = stage.scenery->arena.bounds;
    auto const columns = static_cast<float>(stage.light_columns);
    auto const rows = static_cast<float>(stage.light_rows);
    light->columns = stage.light_columns;
    light->rows = stage.light_rows;
    light->origin_mm = bounds.min;
    light->cell_mm = {bounds.size().x / columns, bounds.size().y / rows};
    light->level.assign(levels, levels + static_cast<std::ptrdiff_t>(stage.light_columns) * stage.light_rows);
    return light;
}

std::vector<LampMark> lamps_of(RecordedStage const& stage, float const* lamps_mm) {
    std::vector<LampMark> marks;
    for (Shape const& shape : stage.lamps) {
        marks.push_back({.centre_mm = point(lamps_mm), .shape = shape, .shape_mm = point(lamps_mm)});
        lamps_mm += 2;
    }
    return marks;
}

/// The body of an object that can be heard, or hear.
std::uint32_t rigid_body(Scenery const& scenery, std::uint32_t object) {
    if (object >= scenery.objects.size() || scenery.objects[object].body_count != 1) {
        throw ConfigError(fmt::format("heard: expected the index of an object with a rigid body, found {}", object));
    }
    return scenery.objects[object].body;
}

LinkedBody linked_body(Scenery const& scenery, Snapshot const& snapshot, std::uint32_t body) {
    return {.shape = scenery.body_shape[body],
            .radius_mm = scenery.body_radius_mm[body],
            .heading_rad = snapshot.heading_rad[body]};
}

InfraredLink infrared_link(Scenery const& scenery, Snapshot const& snapshot, pogosim_infrared_link const& pair) {
    std::uint32_t const from = rigid_body(scenery, pair.sender);
    std::uint32_t const to = rigid_body(scenery, pair.listener);
    Vec2 const from_mm = snapshot.position_mm[from];
    Vec2 const span = minimum_image(scenery, from_mm, snapshot.position_mm[to]);
    InfraredLink link{.from_mm = {},
                      .to_mm = {},
                      .emitters = kAllFaces,
                      .emitters_back = pair.is_mutual != 0 ? kAllFaces : std::uint8_t{0}};
    place_ends(link, from_mm, linked_body(scenery, snapshot, from), span, linked_body(scenery, snapshot, to));
    return link;
}

Snapshot snapshot_of(RecordedStage const& stage, pogosim_moment const& moment) {
    Snapshot snapshot;
    snapshot.scenery = stage.scenery;
    snapshot.time_s = moment.time_s;
    copy_bodies(*stage.scenery, moment, snapshot);
    copy_colours(stage, moment.rgb, snapshot);
    snapshot.lamps = lamps_of(stage, moment.lamps_mm);
    if (moment.trail_counts != nullptr) {
        snapshot.trails = trails_of(*stage.scenery, moment);
    }
    if (moment.velocity_mm_s != nullptr) {
        copy_velocities(*stage.scenery, moment.velocity_mm_s, snapshot);
    }
    if (moment.heat != nullptr && !parts_for(stage.view).heat_map.empty()) {
        snapshot.heat_map = heat_of(stage, moment);
    }
    for (pogosim_infrared_link const& pair : std::span(moment.infrared_links, moment.infrared_link_count)) {
        snapshot.links.push_back(infrared_link(*stage.scenery, snapshot, pair));
    }
    for (pogosim_body_link const& link : std::span(moment.body_links, moment.body_link_count)) {
        snapshot.body_links.push_back({.kind = link_kind_of(link.kind, "links: expected the kind"),
                                       .is_pinned = link.is_pinned != 0,
                                       .from_mm = point(link.from_mm),
                                       .to_mm = point(link.to_mm),
                                       .load = link.load});
    }
    return snapshot;
}

}  // namespace

int pogosim_painter_open(pogosim_stage const* stage, pogosim_painter** painter) {
    *painter = nullptr;
    return with_status([&] {
        auto made = std::make_unique<pogosim_painter>();
        made->stage = read_stage(*stage);
        *painter = made.release();
        return POGOSIM_OK;
    });
}

int pogosim_painter_shows(pogosim_painter const* painter, char const* part, int* is_shown) {
    SnapshotParts const parts = parts_for(painter->stage.view);
    for (auto const& [name, is_wanted] : {std::pair{"trails", parts.trails}, std::pair{"light_levels", parts.light},
                                          std::pair{"links", parts.links}, std::pair{"velocities", parts.velocities}}) {
        if (std::string_view(name) == part) {
            *is_shown = is_wanted ? 1 : 0;
            return POGOSIM_OK;
        }
    }
    return failed(fmt::format("a painter has no part '{}'", part));
}

int pogosim_painter_draw(pogosim_painter* painter, pogosim_moment const* moment, int32_t width_px, int32_t height_px,
                         uint8_t* rgb, size_t stride_bytes) {
    return with_status([&] {
        PictureSize const size = checked_size(width_px, height_px);
        RecordedStage const& stage = painter->stage;
        Snapshot snapshot = snapshot_of(stage, *moment);
        if (moment->light != nullptr) {
            painter->light = light_of(stage, moment->light);
        }
        snapshot.light = painter->light;
        if (painter->canvas.size() != size) {
            painter->canvas.resize(size);
        }
        painter->painter.paint(painter->canvas, camera_for(stage.view, snapshot, size), snapshot, stage.view);
        copy_pixels(painter->canvas, rgb, stride_bytes);
        return POGOSIM_OK;
    });
}

void pogosim_painter_close(pogosim_painter* painter) {
    delete painter;
}
