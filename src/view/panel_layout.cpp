#include "view/panel_layout.hpp"

#include <algorithm>

namespace pogosim {

namespace {

// For text of the usual size.
constexpr float kMarginPx = 10.0F;
constexpr float kInspectorTopPx = 44.0F;  // below the time
constexpr float kLeastInspectorPx = 130.0F;
constexpr Vec2 kPlotPx{620.0F, 230.0F};
constexpr Vec2 kLeastWindowPx{320.0F, 240.0F};

constexpr float kMostCovered = 0.25F;     // of the arena, by all
constexpr float kMostOfControl = 0.125F;  // by the control panel
constexpr float kMostOfInspector = 0.15F;
constexpr float kReserve = 0.005F;

float overlap(float low_a, float high_a, float low_b, float high_b) {
    return std::max(0.0F, std::min(high_a, high_b) - std::max(low_a, low_b));
}

float area(Box const& box) {
    Vec2 const size = box.size();
    return std::max(size.x * size.y, 1.0F);
}

/// The largest height, up to `most_px`, at which a panel whose upper edge is at `top_px` covers at most this much of
/// the arena.
float height_from(float top_px, float left_px, float width_px, float share, float most_px, Box const& arena) {
    float const across = overlap(left_px, left_px + width_px, arena.min.x, arena.max.x);
    if (across <= 0.0F) {
        return most_px;
    }
    return std::min(most_px, std::max(0.0F, arena.min.y - top_px) + share * area(arena) / across);
}

PanelBox collapsed(Vec2 corner_px, PanelRoom const& room) {
    return {corner_px, {kTitleWidthPx * room.scale, room.title_px}, true};
}

bool overlap_each_other(PanelBox const& a, PanelBox const& b) {
    auto const end = [](PanelBox const& box) { return box.corner_px + box.size_px; };
    return overlap(a.corner_px.x, end(a).x, b.corner_px.x, end(b).x) > 0.0F &&
           overlap(a.corner_px.y, end(a).y, b.corner_px.y, end(b).y) > 0.0F;
}

PanelBox lay_control(PanelRoom const& room) {
    Vec2 const corner{kMarginPx, kMarginPx};
    PanelBox const open{corner, {kControlWidthPx * room.scale, room.control_px}};
    float const both_px = (kControlWidthPx + kInspectorWidthPx) * room.scale + 3.0F * kMarginPx;
    bool const is_beside = !room.has_inspector || both_px <= room.window_px.x;
    PanelBox const least{corner,
                         {open.size_px.x, room.control_least_px}};  // sections that the user opens may make it larger
    bool const fits = is_beside && open.size_px.y + 2.0F * kMarginPx <= room.window_px.y &&
                      covered_share(least, room.arena_px) <= kMostOfControl;
    return fits ? open : collapsed(corner, room);
}

PanelBox lay_inspector(PanelRoom const& room, PanelBox const& control, float share) {
    float const width_px = std::min(kInspectorWidthPx * room.scale, room.window_px.x - 2.0F * kMarginPx);
    float const left_px = room.window_px.x - kMarginPx - width_px;
    float const below_control_px =
        left_px < control.corner_px.x + control.size_px.x ? control.corner_px.y + control.size_px.y + kMarginPx : 0.0F;
    float const top_px = std::max(kInspectorTopPx * room.scale, below_control_px);
    // The title of a collapsed plot has room below it.
    float const bottom_px = room.window_px.y - 2.0F * kMarginPx - (room.has_plot ? room.title_px : 0.0F);
    float const height_px = height_from(top_px, left_px, width_px, share, bottom_px - top_px, room.arena_px);
    if (height_px < kLeastInspectorPx * room.scale) {
        return collapsed({room.window_px.x - kMarginPx - kTitleWidthPx * room.scale, top_px}, room);
    }
    return {{left_px, top_px}, {width_px, height_px}};
}

/// Along the lower edge, as large as it may be.
PanelBox lay_plot(PanelRoom const& room, PanelLayout const& others, float share) {
    auto const at_bottom = [&](Vec2 size_px) {
        return PanelBox{{kMarginPx, room.window_px.y - kMarginPx - size_px.y}, size_px};
    };
    auto const is_free = [&](PanelBox const& box) {
        return !overlap_each_other(box, others.control) &&
               (!room.has_inspector || !overlap_each_other(box, others.inspector));
    };
    Vec2 const least_px = room.scale * kLeastPlotPx;
    Vec2 const most_px{std::min(room.scale * kPlotPx.x, room.window_px.x - 2.0F * kMarginPx),
                       std::min(room.scale * kPlotPx.y, 0.5F * room.window_px.y)};
    constexpr int kTries = 20;
    for (int i = 0; i <= kTries; ++i) {
        float const part = 1.0F - static_cast<float>(i) / kTries;
        PanelBox const box = at_bottom(least_px + part * (most_px - least_px));
        if (box.size_px.x <= most_px.x && is_free(box) && covered_share(box, room.arena_px) <= share) {
            return box;
        }
    }
    return collapsed({kMarginPx, room.window_px.y - kMarginPx - room.title_px}, room);
}

}  // namespace

bool has_other_places(PanelLayout const& a, PanelLayout const& b) {
    auto const differ = [](PanelBox const& one, PanelBox const& other) {
        return one.corner_px != other.corner_px || one.is_collapsed != other.is_collapsed;
    };
    return differ(a.control, b.control) || differ(a.inspector, b.inspector) || differ(a.plot, b.plot) ||
           a.plot.size_px != b.plot.size_px;
}

bool has_room_for_panels(Vec2 window_px, float scale) {
    return window_px.x >= scale * kLeastWindowPx.x && window_px.y >= scale * kLeastWindowPx.y;
}

float covered_share(PanelBox const& panel, Box const& arena_px) {
    Vec2 const end_px = panel.corner_px + panel.size_px;
    return overlap(panel.corner_px.x, end_px.x, arena_px.min.x, arena_px.max.x) *
           overlap(panel.corner_px.y, end_px.y, arena_px.min.y, arena_px.max.y) / area(arena_px);
}

PanelLayout lay_out_panels(PanelRoom const& room) {
    PanelLayout layout;
    layout.control = lay_control(room);
    float left = std::max(
        0.0F, kMostCovered - kReserve - std::min(covered_share(layout.control, room.arena_px), kMostOfControl));
    if (room.has_inspector) {
        float const share = std::min(room.has_plot ? 0.5F * left : left, kMostOfInspector);
        layout.inspector = lay_inspector(room, layout.control, share);
        left -= covered_share(layout.inspector, room.arena_px);
    }
    if (room.has_plot) {
        layout.plot = lay_plot(room, layout, left);
    }
    return layout;
}

}  // namespace pogosim
