#include "view/panel_raster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pogosim {
namespace {

constexpr Pixel kBlack = 0xFF000000U;

/// Dear ImGui without a window: what `draw` puts on a list, drawn on black.
class PanelRaster : public ::testing::Test {
protected:
    PanelRaster() : context_(ImGui::CreateContext()), canvas_({kWidth, kHeight}) {
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {kWidth, kHeight};
        io.DeltaTime = 0.01F;
        ImGui::GetStyle().AntiAliasedLinesUseTex = false;
        atlas_ = make_glyph_atlas(*io.Fonts);
    }
    ~PanelRaster() override { ImGui::DestroyContext(context_); }
    PanelRaster(PanelRaster const&) = delete;
    PanelRaster& operator=(PanelRaster const&) = delete;

    template <class Draw>
    void draw(Draw const& draw_list) {
        std::ranges::fill(canvas_.pixels(), kBlack);
        ImGui::NewFrame();
        draw_list(*ImGui::GetForegroundDrawList());
        ImGui::Render();
        draw_panels(canvas_, *ImGui::GetDrawData(), atlas_);
    }

    /// Area that is white, in pixels.
    double white() const {
        double sum = 0.0;
        for (Pixel const pixel : canvas_.pixels()) {
            sum += (pixel & 0xFFU) / 255.0;
        }
        return sum;
    }

    static constexpr int kWidth = 200;
    static constexpr int kHeight = 150;
    static constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255);
    ImGuiContext* context_;
    Canvas canvas_;
    GlyphAtlas atlas_;
};

TEST_F(PanelRaster, ARectangleHasItsArea) {
    draw([](ImDrawList& list) { list.AddRectFilled({10, 20}, {60, 50}, kWhite); });
    EXPECT_NEAR(white(), 50.0 * 30.0, 1e-9);
}

TEST_F(PanelRaster, ADiskHasItsArea) {
    draw([](ImDrawList& list) { list.AddCircleFilled({100.3F, 70.6F}, 40.0F, kWhite, 128); });
    EXPECT_NEAR(white(), 3.14159265 * 40.0 * 40.0, 0.02 * 5026.5);
}

TEST_F(PanelRaster, TrianglesThatShareAnEdgeLeaveNoGapAndDoNotOverlap) {
    constexpr ImU32 half = IM_COL32(255, 255, 255, 128);
    draw([](ImDrawList& list) {
        list.Flags &= ~ImDrawListFlags_AntiAliasedFill;
        list.AddTriangleFilled({10, 10}, {110, 30}, {20, 120}, half);
        list.AddTriangleFilled({110, 30}, {120, 140}, {20, 120}, half);
    });
    for (Pixel const pixel : canvas_.pixels()) {
        unsigned const level = pixel & 0xFFU;
        ASSERT_TRUE(level == 0 || level == 128) << level;
    }
    EXPECT_GT(white(), 0.0);
}

TEST_F(PanelRaster, TextIsDrawnInItsColourAndNowhereElse) {
    draw([](ImDrawList& list) { list.AddText({30, 40}, IM_COL32(255, 0, 0, 255), "Pogobot"); });
    ImVec2 const size = ImGui::CalcTextSize("Pogobot");
    double red = 0.0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            Pixel const pixel = canvas_.pixels()[static_cast<std::size_t>(y * kWidth + x)];
            bool const inside =
                x >= 29 && x <= 31 + static_cast<int>(size.x) && y >= 39 && y <= 41 + static_cast<int>(size.y);
            ASSERT_TRUE(inside || pixel == kBlack) << x << ", " << y;
            ASSERT_EQ(pixel & 0xFFFFU, 0U);
            red += (pixel >> 16U & 0xFFU) / 255.0;
        }
    }
    EXPECT_GT(red, 50.0);
}

TEST_F(PanelRaster, NothingIsDrawnOutsideOfTheClip) {
    draw([](ImDrawList& list) {
        list.PushClipRect({20, 20}, {40, 40});
        list.AddCircleFilled({30, 30}, 500.0F, kWhite);
        list.AddRectFilled({-1e9F, -1e9F}, {1e9F, 1e9F}, kWhite);
        list.PopClipRect();
    });
    EXPECT_NEAR(white(), 400.0, 1e-9);
}

TEST_F(PanelRaster, CoordinatesThatAreNoNumbersDrawNothing) {
    draw([](ImDrawList& list) {
        list.Flags = 0;
        list.AddTriangleFilled({NAN, 10}, {110, NAN}, {20, 120}, kWhite);
        list.AddTriangleFilled({INFINITY, 10}, {110, -INFINITY}, {20, 120}, kWhite);
    });
    EXPECT_EQ(white(), 0.0);
}

}  // namespace
}  // namespace pogosim
