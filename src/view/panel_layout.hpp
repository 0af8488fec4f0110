// Where panels are at first: at most a quarter of the arena is under them, and none is under another one. Panels
// without room are collapsed to their titles.
#pragma once

#include "base/vec2.hpp"

namespace pogosim {

// For text of the usual size.
inline constexpr float kControlWidthPx = 236.0F;
inline constexpr float kInspectorWidthPx = 286.0F;
inline constexpr float kTitleWidthPx = 120.0F;  // of a collapsed panel
inline constexpr Vec2 kLeastPlotPx{250.0F, 130.0F};

/// The inputs of the layout. Sizes in pixels.
struct PanelRoom {
    Vec2 window_px;
    Box arena_px;                     // when all of it is shown
    float scale = 1.0F;               // of the text
    float title_px = 22.0F;           // height of a title
    float control_px = 150.0F;        // height that the control panel needs
    float control_least_px = 150.0F;  // the same while its section "View" is closed
    bool has_inspector = false;
    bool has_plot = false;
};

struct PanelBox {
    Vec2 corner_px;  // top left
    Vec2 size_px;    // of the inspector: at most so high
    bool is_collapsed = false;
};

struct PanelLayout {
    PanelBox control;
    PanelBox inspector;
    PanelBox plot;
};

/// Whether panels that were put into their places have to be put there again.
bool has_other_places(PanelLayout const& a, PanelLayout const& b);

/// False: too small a window for any panel.
bool has_room_for_panels(Vec2 window_px, float scale);

PanelLayout lay_out_panels(PanelRoom const& room);

/// The part of a panel that is over the arena, by the size of the arena.
float covered_share(PanelBox const& panel, Box const& arena_px);

}  // namespace pogosim
