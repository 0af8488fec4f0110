#include "render/camera.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace pogosim {
namespace {

constexpr PictureSize kSize{800, 600};
constexpr Box kArena{{-100.0F, 50.0F}, {1900.0F, 1050.0F}};

void expect_near(Vec2 a, Vec2 b, float tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
}

TEST(Camera, SeesThePointUnderAPixelAtThatPixel) {
    Camera const camera{{300.0F, 200.0F}, 0.37F};
    for (Vec2 const point : {Vec2{0, 0}, Vec2{-512, 77}, Vec2{300, 200}, Vec2{1234, 4321}}) {
        expect_near(camera.to_mm(camera.to_pixels(point, kSize), kSize), point, 1e-2F);
    }
}

TEST(Camera, HasItsCentreInTheMiddleAndYDownwards) {
    Camera const camera{{300.0F, 200.0F}, 2.0F};
    expect_near(camera.to_pixels({300.0F, 200.0F}, kSize), {400.0F, 300.0F}, 1e-4F);
    expect_near(camera.to_pixels({310.0F, 205.0F}, kSize), {420.0F, 310.0F}, 1e-4F);
}

TEST(Camera, FitsTheWholeArenaAndFillsTheLongerSide) {
    for (PictureSize const size : {kSize, PictureSize{300, 900}, PictureSize{1, 1}}) {
        Camera const camera = fitted(kArena, size);
        Vec2 const low = camera.to_pixels(kArena.min, size);
        Vec2 const high = camera.to_pixels(kArena.max, size);
        float const across = (high.x - low.x) / static_cast<float>(size.width_px);
        float const down = (high.y - low.y) / static_cast<float>(size.height_px);
        EXPECT_NEAR(std::max(across, down), kFitMargin, 1e-4);
        EXPECT_GE(low.x, 0.0F);
        EXPECT_GE(low.y, 0.0F);
        expect_near(0.5F * (low + high), camera.to_pixels(kArena.centre(), size), 1e-2F);
    }
}

TEST(Camera, OfAnEmptyBoxOrPictureHasAFiniteScale) {
    EXPECT_GT(fitted({{5, 5}, {5, 5}}, kSize).scale_px_mm, 0.0F);
    EXPECT_GT(fitted(kArena, {0, 0}).scale_px_mm, 0.0F);
}

TEST(Zoom, KeepsThePointUnderTheMouse) {
    Camera const camera = fitted(kArena, kSize);
    Vec2 const mouse{123.0F, 456.0F};
    Camera const closer = zoomed(camera, 1.7F, mouse, kSize, zoom_limits(kArena, kSize));
    EXPECT_FLOAT_EQ(closer.scale_px_mm, 1.7F * camera.scale_px_mm);
    expect_near(closer.to_mm(mouse, kSize), camera.to_mm(mouse, kSize), 1e-2F);
}

TEST(Zoom, StaysWithinItsLimits) {
    ZoomLimits const limits = zoom_limits(kArena, kSize);
    EXPECT_FLOAT_EQ(limits.least_px_mm, 0.1F);
    EXPECT_FLOAT_EQ(limits.most_px_mm, 10.0F);
    Camera const camera = fitted(kArena, kSize);
    EXPECT_FLOAT_EQ(zoomed(camera, 1e9F, {}, kSize, limits).scale_px_mm, 10.0F);
    EXPECT_FLOAT_EQ(zoomed(camera, 1e-9F, {}, kSize, limits).scale_px_mm, 0.1F);
}

TEST(Zoom, AlwaysReachesTheScaleAtWhichTheArenaFits) {
    for (float const side_mm : {1.0F, 1000.0F, 1e6F}) {
        Box const bounds{{0, 0}, {side_mm, side_mm}};
        ZoomLimits const limits = zoom_limits(bounds, kSize);
        float const fit = fitted(bounds, kSize).scale_px_mm;
        EXPECT_LE(limits.least_px_mm, fit);
        EXPECT_GE(limits.most_px_mm, fit);
    }
}

}  // namespace
}  // namespace pogosim
