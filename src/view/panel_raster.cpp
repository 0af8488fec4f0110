// Rectangles, of which text and most of a panel consist, are copied row by row. Other triangles are filled with edge
// functions: J. Pineda, "A Parallel Algorithm for Polygon Rasterization", SIGGRAPH 1988.
#include "view/panel_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pogosim {

namespace {

struct Clip {
    int left;
    int top;
    int right;  // first column and row beyond
    int bottom;
};

constexpr unsigned kOpaque = 255;

/// x / 255, rounded, for x up to 255 * 255.
unsigned divide_by_255(unsigned x) {
    return (x + 128U + ((x + 128U) >> 8U)) >> 8U;
}

unsigned channel(std::uint32_t color, unsigned shift) {
    return color >> shift & 0xFFU;
}

/// Dear ImGui's order of channels is red first.
Pixel blended(Pixel below, unsigned red, unsigned green, unsigned blue, unsigned alpha) {
    auto const mix = [&](unsigned over, unsigned shift) {
        return divide_by_255(over * alpha + channel(below, shift) * (kOpaque - alpha)) << shift;
    };
    return 0xFF000000U | mix(red, 16) | mix(green, 8) | mix(blue, 0);
}

Pixel blended(Pixel below, ImU32 color, unsigned opacity) {
    unsigned const alpha = divide_by_255(channel(color, IM_COL32_A_SHIFT) * opacity);
    return blended(below, channel(color, IM_COL32_R_SHIFT), channel(color, IM_COL32_G_SHIFT),
                   channel(color, IM_COL32_B_SHIFT), alpha);
}

class Raster {
public:
    Raster(Canvas& canvas, GlyphAtlas const& atlas)
        : width_(canvas.size().width_px), height_(canvas.size().height_px), pixels_(canvas.pixels()), atlas_(atlas) {}

    Clip clip_of(ImVec4 const& box) const {
        auto const bounded = [](float value, int most) {
            return value > 0.0F ? static_cast<int>(std::min(value, static_cast<float>(most))) : 0;  // also of NaN
        };
        return {bounded(box.x, width_), bounded(box.y, height_), bounded(box.z, width_), bounded(box.w, height_)};
    }

    void fill_rectangle(Clip const& clip, ImDrawVert const& first, ImDrawVert const& last) {
        int const left = static_cast<int>(std::lround(first.pos.x));
        int const top = static_cast<int>(std::lround(first.pos.y));
        int const right = static_cast<int>(std::lround(last.pos.x));
        int const bottom = static_cast<int>(std::lround(last.pos.y));
        bool const plain = first.uv.x == last.uv.x && first.uv.y == last.uv.y;
        float const u_step = (last.uv.x - first.uv.x) / static_cast<float>(std::max(right - left, 1));
        float const v_step = (last.uv.y - first.uv.y) / static_cast<float>(std::max(bottom - top, 1));
        for (int y = std::max(top, clip.top); y < std::min(bottom, clip.bottom); ++y) {
            for (int x = std::max(left, clip.left); x < std::min(right, clip.right); ++x) {
                Pixel& pixel = pixel_at(x, y);
                unsigned const opacity = plain ? kOpaque
                                               : glyph_at(first.uv.x + (static_cast<float>(x - left) + 0.5F) * u_step,
                                                          first.uv.y + (static_cast<float>(y - top) + 0.5F) * v_step);
                pixel = opacity == 0 ? pixel : blended(pixel, first.col, opacity);
            }
        }
    }

    void fill_triangle(Clip const& clip, std::array<ImDrawVert const*, 3> corner) {
        float area = edge(corner[0]->pos, corner[1]->pos, corner[2]->pos);
        if (!(std::abs(area) > 0.0F) || !std::isfinite(area)) {
            return;
        }
        if (area < 0.0F) {
            std::swap(corner[1], corner[2]);
            area = -area;
        }
        auto const [x_min, x_max] = std::minmax({corner[0]->pos.x, corner[1]->pos.x, corner[2]->pos.x});
        auto const [y_min, y_max] = std::minmax({corner[0]->pos.y, corner[1]->pos.y, corner[2]->pos.y});
        Clip const box = clip_of({x_min, y_min, x_max + 1.0F, y_max + 1.0F});
        for (int y = std::max(box.top, clip.top); y < std::min(box.bottom, clip.bottom); ++y) {
            for (int x = std::max(box.left, clip.left); x < std::min(box.right, clip.right); ++x) {
                ImVec2 const centre(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
                std::array<float, 3> share{};
                bool inside = true;
                for (std::size_t i = 0; i < 3; ++i) {
                    ImVec2 const& from = corner[(i + 1) % 3]->pos;
                    ImVec2 const& to = corner[(i + 2) % 3]->pos;
                    share[i] = edge(from, to, centre);
                    inside = inside && (share[i] > 0.0F || (share[i] == 0.0F && is_top_left(from, to)));
                    share[i] /= area;
                }
                if (inside) {
                    blend_inside(pixel_at(x, y), corner, share);
                }
            }
        }
    }

private:
    /// Twice the area of the triangle; positive when it is clockwise on the screen.
    static float edge(ImVec2 const& a, ImVec2 const& b, ImVec2 const& c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    }

    /// Pixels on an edge shared by two triangles belong to one of them only.
    static bool is_top_left(ImVec2 const& from, ImVec2 const& to) {
        return (to.y == from.y && to.x > from.x) || to.y < from.y;
    }

    static void blend_inside(Pixel& pixel, std::array<ImDrawVert const*, 3> const& corner,
                             std::array<float, 3> const& share) {
        auto const mixed = [&](unsigned shift) {
            float sum = 0.5F;
            for (std::size_t i = 0; i < 3; ++i) {
                sum += share[i] * static_cast<float>(channel(corner[i]->col, shift));
            }
            return static_cast<unsigned>(std::clamp(sum, 0.0F, 255.0F));
        };
        pixel = blended(pixel, mixed(IM_COL32_R_SHIFT), mixed(IM_COL32_G_SHIFT), mixed(IM_COL32_B_SHIFT),
                        mixed(IM_COL32_A_SHIFT));
    }

    Pixel& pixel_at(int x, int y) {
        return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    }

    unsigned glyph_at(float u, float v) const {
        auto const cell = [](float share, int count) {
            return static_cast<std::size_t>(
                std::clamp(static_cast<int>(share * static_cast<float>(count)), 0, count - 1));
        };
        return atlas_.opacity[cell(v, atlas_.height) * static_cast<std::size_t>(atlas_.width) + cell(u, atlas_.width)];
    }

    int width_;
    int height_;
    std::span<Pixel> pixels_;
    GlyphAtlas const& atlas_;
};

/// Two triangles that make an upright rectangle of one colour, from its first corner (top left) to its third.
bool is_rectangle(ImDrawVert const* vertices, ImDrawIdx const* index, unsigned left_over) {
    if (left_over < 6 || index[3] != index[0] || index[4] != index[2]) {
        return false;
    }
    ImDrawVert const& a = vertices[index[0]];
    ImDrawVert const& b = vertices[index[1]];
    ImDrawVert const& c = vertices[index[2]];
    ImDrawVert const& d = vertices[index[5]];
    bool const upright = a.pos.y == b.pos.y && b.pos.x == c.pos.x && c.pos.y == d.pos.y && d.pos.x == a.pos.x &&
                         a.pos.x <= c.pos.x && a.pos.y <= c.pos.y;
    return upright && a.col == b.col && b.col == c.col && c.col == d.col;
}

}  // namespace

GlyphAtlas make_glyph_atlas(ImFontAtlas& fonts) {
    GlyphAtlas atlas;
    unsigned char* opacity = nullptr;
    fonts.GetTexDataAsAlpha8(&opacity, &atlas.width, &atlas.height);
    atlas.opacity.assign(opacity, opacity + static_cast<std::ptrdiff_t>(atlas.width) * atlas.height);
    return atlas;
}

void draw_panels(Canvas& canvas, ImDrawData const& panels, GlyphAtlas const& atlas) {
    Raster raster(canvas, atlas);
    for (int i = 0; i < panels.CmdListsCount; ++i) {
        ImDrawList const& list = *panels.CmdLists[i];
        for (ImDrawCmd const& command : list.CmdBuffer) {
            Clip const clip = raster.clip_of(command.ClipRect);
            ImDrawVert const* const vertices = list.VtxBuffer.Data + command.VtxOffset;
            ImDrawIdx const* const indices = list.IdxBuffer.Data + command.IdxOffset;
            for (unsigned k = 0; k + 2 < command.ElemCount; k += 3) {
                ImDrawIdx const* const index = indices + k;
                if (is_rectangle(vertices, index, command.ElemCount - k)) {
                    raster.fill_rectangle(clip, vertices[index[0]], vertices[index[2]]);
                    k += 3;
                } else {
                    raster.fill_triangle(clip, {vertices + index[0], vertices + index[1], vertices + index[2]});
                }
            }
        }
    }
}

}  // namespace pogosim
