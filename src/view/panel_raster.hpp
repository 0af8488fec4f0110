// Draws the triangles of Dear ImGui into a canvas, without a graphics card.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <vector>

#include "render/canvas.hpp"

namespace pogosim {

/// The glyphs of the atlas, one byte of opacity each.
struct GlyphAtlas {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> opacity;  // row by row
};

/// Builds the atlas of the fonts that have been added.
GlyphAtlas make_glyph_atlas(ImFontAtlas& fonts);

/// Over what is there. All textures are taken for the atlas.
void draw_panels(Canvas& canvas, ImDrawData const& panels, GlyphAtlas const& atlas);

}  // namespace pogosim
