// Panels leave most of the arena free, and each other, in every window.
#include "view/panel_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "render/camera.hpp"

namespace pogosim {
namespace {

PanelRoom room_of(PictureSize size, Box const& arena_mm, float scale) {
    Camera const camera = fitted(arena_mm, size);
    return {.window_px = {static_cast<float>(size.width_px), static_cast<float>(size.height_px)},
            .arena_px = {camera.to_pixels(arena_mm.min, size), camera.to_pixels(arena_mm.max, size)},
            .scale = scale,
            .title_px = 22.0F * scale,
            .control_px = 150.0F * scale,
            .control_least_px = 150.0F * scale};
}

std::vector<PanelBox> panels_of(PanelLayout const& layout, PanelRoom const& room) {
    std::vector<PanelBox> panels{layout.control};
    if (room.has_inspector) {
        panels.push_back(layout.inspector);
    }
    if (room.has_plot) {
        panels.push_back(layout.plot);
    }
    return panels;
}

bool overlap(PanelBox const& a, PanelBox const& b) {
    auto const apart = [](float low_a, float size_a, float low_b, float size_b) {
        return low_a + size_a <= low_b || low_b + size_b <= low_a;
    };
    return !apart(a.corner_px.x, a.size_px.x, b.corner_px.x, b.size_px.x) &&
           !apart(a.corner_px.y, a.size_px.y, b.corner_px.y, b.size_px.y);
}

/// Windows, arenas, sizes of text and choices of panels.
std::vector<PanelRoom> rooms() {
    std::vector<PanelRoom> all;
    for (PictureSize const size : {PictureSize{320, 240},
                                   {400, 900},
                                   {640, 480},
                                   {800, 600},
                                   {1024, 768},
                                   {1240, 740},
                                   {1200, 300},
                                   {1400, 1100},
                                   {1920, 1080},
                                   {3840, 2160}}) {
        for (Vec2 const arena_mm : {Vec2{1000, 1000}, Vec2{3000, 1000}, Vec2{500, 2000}}) {
            for (float const scale : {1.0F, 1.5F, 2.0F}) {
                for (int choice = 0; choice < 4; ++choice) {
                    PanelRoom room = room_of(size, {{}, arena_mm}, scale);
                    room.has_inspector = (choice & 1) != 0;
                    room.has_plot = (choice & 2) != 0;
                    if (has_room_for_panels(room.window_px, scale)) {
                        all.push_back(room);
                        room.control_px = 330.0F * scale;  // with its section "View" open
                        all.push_back(room);
                    }
                }
            }
        }
    }
    return all;
}

std::string text_of(PanelRoom const& room) {
    return "window " + std::to_string(room.window_px.x) + " x " + std::to_string(room.window_px.y) + ", arena " +
           std::to_string(room.arena_px.size().x) + " x " + std::to_string(room.arena_px.size().y) + ", scale " +
           std::to_string(room.scale) + (room.has_inspector ? ", inspector" : "") + (room.has_plot ? ", plot" : "");
}

TEST(PanelLayout, CoversAtMostAQuarterOfTheArena) {
    for (PanelRoom const& room : rooms()) {
        if (room.control_px > room.control_least_px) {
            continue;  // as the user wants it
        }
        float covered = 0.0F;
        for (PanelBox const& panel : panels_of(lay_out_panels(room), room)) {
            covered += covered_share(panel, room.arena_px);
        }
        EXPECT_LE(covered, 0.25F) << text_of(room);
    }
}

TEST(PanelLayout, NoPanelIsUnderAnotherOneOrOutsideOfTheWindow) {
    for (PanelRoom const& room : rooms()) {
        std::vector<PanelBox> const panels = panels_of(lay_out_panels(room), room);
        for (std::size_t i = 0; i < panels.size(); ++i) {
            EXPECT_GE(panels[i].corner_px.x, 0.0F) << text_of(room);
            EXPECT_GE(panels[i].corner_px.y, 0.0F) << text_of(room);
            EXPECT_LE(panels[i].corner_px.x + panels[i].size_px.x, room.window_px.x) << text_of(room);
            EXPECT_LE(panels[i].corner_px.y + panels[i].size_px.y, room.window_px.y) << text_of(room);
            for (std::size_t j = 0; j < i; ++j) {
                EXPECT_FALSE(overlap(panels[i], panels[j])) << text_of(room) << ": " << j << " and " << i;
            }
        }
    }
}

TEST(PanelLayout, CollapsesNothingInAUsualWindow) {
    PanelRoom room = room_of({1240, 740}, {{}, {1000, 1000}}, 1.0F);
    room.has_inspector = room.has_plot = true;
    PanelLayout const layout = lay_out_panels(room);
    EXPECT_FALSE(layout.control.is_collapsed);
    EXPECT_FALSE(layout.inspector.is_collapsed);
    EXPECT_FALSE(layout.plot.is_collapsed);
}

TEST(PanelLayout, CollapsesWhatHasNoRoomInASmallWindow) {
    PanelRoom room = room_of({320, 240}, {{}, {1000, 1000}}, 1.0F);
    room.has_inspector = room.has_plot = true;
    PanelLayout const layout = lay_out_panels(room);
    EXPECT_TRUE(layout.control.is_collapsed);
    EXPECT_TRUE(layout.inspector.is_collapsed);
    EXPECT_TRUE(layout.plot.is_collapsed);
    EXPECT_FALSE(has_room_for_panels({319, 240}, 1.0F));
    EXPECT_FALSE(has_room_for_panels({320, 240}, 2.0F));
}

}  // namespace
}  // namespace pogosim
