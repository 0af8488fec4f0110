#include "render/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/polygon.hpp"

namespace pogosim {
namespace {

constexpr Pixel kWhite = 0xFFFFFFFF;
constexpr float kPi = std::numbers::pi_v<float>;

/// What was drawn in white on black: how many pixels it covers, and where their centre is.
struct Mark {
    double area = 0.0;
    double x = 0.0;
    double y = 0.0;
};

Mark mark_on(Canvas const& canvas) {
    Mark mark;
    for (int y = 0; y < canvas.size().height_px; ++y) {
        for (int x = 0; x < canvas.size().width_px; ++x) {
            double const share =
                (canvas.pixels()[static_cast<std::size_t>(y * canvas.size().width_px + x)] & 0xFFU) / 255.0;
            mark.area += share;
            mark.x += share * (x + 0.5);
            mark.y += share * (y + 0.5);
        }
    }
    mark.x /= mark.area;
    mark.y /= mark.area;
    return mark;
}

Mark mark_of(std::function<void(Canvas&)> const& draw) {
    Canvas canvas({120, 110});
    draw(canvas);
    return mark_on(canvas);
}

constexpr float kOffsets[] = {0.0F, 0.21F, 0.5F, 0.73F};

TEST(Disk, HasTheAreaAndTheCentreOfTheCircleWhereverItLies) {
    for (float const radius : {0.4F, 1.0F, 2.3F, 6.5F, 20.0F, 40.25F}) {
        for (float const offset : kOffsets) {
            Vec2 const centre{60.0F + offset, 55.0F - 0.7F * offset};
            Mark const mark = mark_of([&](Canvas& canvas) { canvas.disk(centre, radius, kWhite); });
            double const tolerance = radius < 2.0F ? 0.07 : 0.01;
            EXPECT_NEAR(mark.area / (kPi * radius * radius), 1.0, tolerance) << radius << " at " << offset;
            EXPECT_NEAR(mark.x, centre.x, tolerance + 0.02) << radius;
            EXPECT_NEAR(mark.y, centre.y, tolerance + 0.02) << radius;
        }
    }
}

TEST(HalfDisk, HasHalfTheAreaOnTheSideThatItFaces) {
    for (float const angle : {0.0F, 0.4F, 2.0F, -2.5F}) {
        float const radius = 14.0F;
        Vec2 const centre{60.3F, 55.6F};
        Mark const mark = mark_of([&](Canvas& canvas) { canvas.half_disk(centre, radius, direction(angle), kWhite); });
        EXPECT_NEAR(mark.area / (0.5 * kPi * radius * radius), 1.0, 0.01);
        float const away = 4.0F * radius / (3.0F * kPi);  // centroid of a half disk
        EXPECT_NEAR(mark.x, centre.x + away * std::cos(angle), 0.1);
        EXPECT_NEAR(mark.y, centre.y + away * std::sin(angle), 0.1);
    }
}

TEST(Ring, HasTheAreaBetweenItsCircles) {
    for (float const width : {0.6F, 1.0F, 2.5F, 7.0F}) {
        float const radius = 30.2F;
        Mark const mark = mark_of([&](Canvas& canvas) { canvas.ring({60.4F, 55.1F}, radius, width, kWhite); });
        EXPECT_NEAR(mark.area / (2.0 * kPi * radius * width), 1.0, 0.01) << width;
        EXPECT_NEAR(mark.x, 60.4, 0.05);
    }
}

TEST(Line, WithButtCapsHasTheAreaOfARectangle) {
    for (float const width : {0.5F, 1.0F, 1.7F, 4.0F, 11.0F}) {
        for (float const angle : {0.0F, 0.3F, 0.785F, 1.5708F, 2.2F, -1.0F}) {
            Vec2 const from{60.2F, 55.7F};
            Vec2 const to = from + 37.0F * direction(angle);
            Mark const mark = mark_of([&](Canvas& canvas) { canvas.line(from, to, width, Cap::butt, kWhite); });
            EXPECT_NEAR(mark.area / (37.0 * width), 1.0, 0.01) << width << " at " << angle;
            double const tolerance =
                width < 1.0F ? 0.25 : 0.12;  // the place of a thin line inside a pixel is not visible
            EXPECT_NEAR(mark.x, 0.5F * (from.x + to.x), tolerance);
            EXPECT_NEAR(mark.y, 0.5F * (from.y + to.y), tolerance);
        }
    }
}

TEST(Line, WithRoundCapsHasAHalfDiskAtEitherEnd) {
    for (float const width : {3.0F, 6.0F, 15.0F}) {
        for (float const angle : {0.0F, 0.5F, 1.9F}) {
            Vec2 const from{60.2F, 55.7F};
            Vec2 const to = from + 30.0F * direction(angle);
            Mark const mark = mark_of([&](Canvas& canvas) { canvas.line(from, to, width, Cap::round, kWhite); });
            double const area = 30.0 * width + 0.25 * kPi * width * width;
            EXPECT_NEAR(mark.area / area, 1.0, 0.01) << width << " at " << angle;
        }
    }
}

TEST(Chain, OfShortPiecesHasTheAreaOfOneLine) {
    for (float const width : {0.6F, 1.3F, 2.5F}) {
        for (float const angle : {0.0F, 0.3F, 1.2F, 1.5708F, 2.9F}) {
            Mark const mark = mark_of([&](Canvas& canvas) {
                Vec2 const start = Vec2{60.0F, 55.0F} - 20.0F * direction(angle);
                for (int i = 0; i < 16; ++i) {
                    canvas.chain_link(start + 2.5F * static_cast<float>(i) * direction(angle),
                                      start + 2.5F * static_cast<float>(i + 1) * direction(angle), width, kWhite);
                }
            });
            EXPECT_NEAR(mark.area / (40.0 * width), 1.0, 0.03) << width << " at " << angle;
        }
    }
}

TEST(Chain, NearTheBorderIsThereToo) {
    Mark const mark = mark_of([](Canvas& canvas) { canvas.chain_link({0.0F, 0.5F}, {120.0F, 0.5F}, 1.0F, kWhite); });
    EXPECT_NEAR(mark.area, 120.0, 1.0);
}

TEST(Polygon, HasItsAreaAndItsCentroidWhereverItLies) {
    Polygon const shape{{10.0F, 12.0F}, {61.5F, 8.3F}, {40.0F, 35.0F}, {72.0F, 70.7F}, {33.0F, 50.0F}};
    for (float const offset : kOffsets) {
        Polygon polygon = moved(shape, {offset, 0.6F * offset}, 0.0F);
        for (bool const is_reversed : {false, true}) {
            if (is_reversed) {
                std::reverse(polygon.begin(), polygon.end());
            }
            Mark const mark = mark_of([&](Canvas& canvas) { canvas.polygon(polygon, kWhite); });
            EXPECT_NEAR(mark.area / std::abs(signed_area(polygon)), 1.0, 0.001);
            EXPECT_NEAR(mark.x, centroid(polygon).x, 0.01);
            EXPECT_NEAR(mark.y, centroid(polygon).y, 0.01);
        }
    }
}

TEST(Polygon, OfLessThanAPixelCoversItsShare) {
    Polygon const polygon{{50.2F, 50.3F}, {50.7F, 50.3F}, {50.7F, 50.7F}, {50.2F, 50.7F}};
    EXPECT_NEAR(mark_of([&](Canvas& canvas) { canvas.polygon(polygon, kWhite); }).area, 0.2, 0.005);
}

TEST(Polygon, PartlyOutsideOfThePictureCoversTheRest) {
    Polygon const polygon{{-100.0F, -50.0F}, {60.0F, -50.0F}, {60.0F, 55.0F}, {-100.0F, 55.0F}};
    EXPECT_NEAR(mark_of([&](Canvas& canvas) { canvas.polygon(polygon, kWhite); }).area, 60.0 * 55.0, 1.0);
    Polygon const around{{-1e7F, -1e7F}, {1e7F, -1e7F}, {1e7F, 1e7F}, {-1e7F, 1e7F}};
    EXPECT_NEAR(mark_of([&](Canvas& canvas) { canvas.polygon(around, kWhite); }).area, 120.0 * 110.0, 1.0);
}

TEST(Coverage, OfPolygonsLeavesTheirHolesOpen) {
    std::vector<Polygon> const polygons{{{10, 10}, {90, 10}, {90, 90}, {10, 90}},
                                        {{30, 30}, {30, 50.5}, {60, 50.5}, {60, 30}}};
    Coverage coverage;
    Mark const mark = mark_of([&](Canvas& canvas) {
        coverage.reset(canvas.bounds());
        coverage.add_polygons(polygons);
        canvas.cover(coverage, kWhite);
    });
    EXPECT_NEAR(mark.area, 80.0 * 80.0 - 30.0 * 20.5, 1.0);
}

TEST(Coverage, OfALineThatCrossesItselfCountsTheCrossingOnce) {
    Coverage coverage;
    Mark const mark = mark_of([&](Canvas& canvas) {
        coverage.reset(canvas.bounds());
        coverage.add_line({20.5F, 50.0F}, {100.5F, 50.0F}, 4.0F);
        coverage.add_line({60.5F, 20.0F}, {60.5F, 80.0F}, 4.0F);
        canvas.cover(coverage, with_opacity(kWhite, 0.5F));
    });
    EXPECT_NEAR(mark.area, 0.5 * (80.0 * 4.0 + 60.0 * 4.0 - 16.0 + 8.0 * kPi), 3.0);
}

TEST(Glow, FadesFromItsCentreToNothingAtItsRadius) {
    Canvas canvas({101, 101});
    Coverage everywhere;
    everywhere.reset(canvas.bounds());
    everywhere.add_polygons(std::vector<Polygon>{{{0, 0}, {101, 0}, {101, 101}, {0, 101}}});
    canvas.glow({50.5F, 50.5F}, 40.0F, kWhite, everywhere);
    auto const at = [&](int x) { return canvas.pixels()[static_cast<std::size_t>(50 * 101 + x)] & 0xFFU; };
    EXPECT_EQ(at(50), 255U);
    for (int x = 51; x < 91; ++x) {
        EXPECT_LE(at(x), at(x - 1));
    }
    EXPECT_NEAR(at(70), 255.0 * 0.5625, 1.0);  // (1 - 1/4)^2
    EXPECT_EQ(at(91), 0U);
}

TEST(Glow, ShinesOnWhatIsCoveredOnly) {
    Canvas canvas({101, 101});
    Coverage left_half;
    left_half.reset(canvas.bounds());
    left_half.add_polygons(std::vector<Polygon>{{{0, 0}, {50, 0}, {50, 101}, {0, 101}}});
    canvas.glow({50.0F, 50.0F}, 30.0F, kWhite, left_half);
    for (int y = 0; y < 101; ++y) {
        for (int x = 50; x < 101; ++x) {
            ASSERT_EQ(canvas.pixels()[static_cast<std::size_t>(y * 101 + x)], 0xFF000000U);
        }
    }
    EXPECT_GT(canvas.pixels()[50 * 101 + 40] & 0xFFU, 100U);
}

TEST(Opacity, MixesTheColourWithWhatIsBelow) {
    Canvas canvas({3, 3});
    canvas.fill(0xFF204060U);
    canvas.disk({1.5F, 1.5F}, 50.0F, with_opacity(0xFFA0C0E0U, 0.5F));
    Pixel const mixed = canvas.pixels()[4];
    EXPECT_EQ(mixed >> 24U, 255U);
    EXPECT_NEAR(mixed >> 16U & 0xFFU, 0x60, 1);
    EXPECT_NEAR(mixed >> 8U & 0xFFU, 0x80, 1);
    EXPECT_NEAR(mixed & 0xFFU, 0xA0, 1);
}

/// Everything that can be drawn, around a point and with a size.
void draw_everything(Canvas& canvas, Vec2 at, float size, Coverage& coverage) {
    Vec2 const other = at + Vec2{size, 0.3F * size};
    canvas.disk(at, size, kWhite);
    canvas.half_disk(at, size, {0.6F, 0.8F}, kWhite);
    canvas.ring(at, size, 0.3F * size, kWhite);
    canvas.line(at, other, 0.2F * size, Cap::butt, kWhite);
    canvas.line(at, other, 0.2F * size, Cap::round, kWhite);
    canvas.line(other, at, 2.0F, Cap::round, kWhite);
    canvas.chain_link(at, other, 1.5F, kWhite);
    canvas.chain_link(at, other, size, kWhite);
    Polygon const polygon{at, other, at + Vec2{0.0F, size}};
    canvas.polygon(polygon, kWhite);
    coverage.reset(canvas.bounds());
    coverage.add_polygons(std::vector<Polygon>{polygon});
    coverage.add_line(at, other, size);
    coverage.add_glow(at, other, size);
    canvas.cover(coverage, kWhite);
    canvas.glow(at, size, kWhite, coverage);
    std::uint8_t const glyph[4] = {255, 128, 255, 128};
    canvas.stamp(glyph, 2, 2, 2, static_cast<int>(std::lround(std::fmin(std::fmax(at.x, -1e4F), 1e4F))), 3, kWhite);
}

TEST(Clip, KeepsAllOutsideOfItAsItWas) {
    PixelBox const clip{20, 30, 71, 64};
    for (Vec2 const at : {Vec2{40, 40}, Vec2{19, 29}, Vec2{71, 64}, Vec2{-30, 50}, Vec2{200, 200}}) {
        for (float const size : {3.0F, 25.0F, 300.0F}) {
            Canvas canvas({120, 110});
            canvas.clip_to(clip);
            Coverage coverage;
            draw_everything(canvas, at, size, coverage);
            for (int y = 0; y < 110; ++y) {
                for (int x = 0; x < 120; ++x) {
                    bool const is_inside = x >= clip.left && x < clip.right && y >= clip.top && y < clip.bottom;
                    if (!is_inside) {
                        ASSERT_EQ(canvas.pixels()[static_cast<std::size_t>(y * 120 + x)], 0xFF000000U)
                            << x << ", " << y;
                    }
                }
            }
        }
    }
}

TEST(Canvas, IsDrawnOnWithAnyNumbers) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kHuge = std::numeric_limits<float>::max();
    float const numbers[] = {0.0F,  -0.0F, 0.5F,       1e-30F,     -3.0F,
                             1e5F,  -1e9F, 1e20F,      kHuge,      -kHuge,
                             1e38F, 40.0F, -kInfinity, +kInfinity, std::numeric_limits<float>::quiet_NaN()};
    for (PictureSize const size : {PictureSize{64, 48}, PictureSize{1, 1}, PictureSize{0, 0}, PictureSize{-5, 3}}) {
        Canvas canvas(size);
        Coverage coverage;
        for (float const x : numbers) {
            for (float const y : numbers) {
                for (float const extent : numbers) {
                    draw_everything(canvas, {x, y}, extent, coverage);
                }
            }
        }
    }
}

TEST(Glow, OnAFloorThatIsOutOfThePictureIsNotDrawn) {
    Canvas canvas({50, 50});
    canvas.fill(0xFF000000U);
    Coverage floor;
    floor.reset({50, 10, 50, 40});
    canvas.glow({49.0F, 25.0F}, 20.0F, 0xFFFFFFFFU, floor);
    canvas.cover(floor, 0xFFFFFFFFU);
    EXPECT_TRUE(std::ranges::all_of(canvas.pixels(), [](Pixel pixel) { return pixel == 0xFF000000U; }));
}

TEST(Layer, DrawnOverAPictureIsTheSameAsDrawnIntoIt) {
    auto const draw = [](Canvas& canvas) {
        canvas.disk({20.3F, 25.1F}, 12.0F, 0x80FF4020U);
        canvas.disk({30.7F, 24.2F}, 12.0F, 0xA02040FFU);
        canvas.line({5.0F, 5.0F}, {45.0F, 40.0F}, 2.5F, Cap::round, 0x40FFFFFFU);
    };
    Canvas direct({50, 50});
    direct.fill(0xFF336699U);
    Canvas below = direct;
    Canvas layer({50, 50});
    layer.clear();
    draw(direct);
    draw(layer);
    below.lay_over(layer);
    for (std::size_t i = 0; i < direct.pixels().size(); ++i) {
        for (unsigned const shift : {0U, 8U, 16U, 24U}) {
            int const a = static_cast<int>(direct.pixels()[i] >> shift & 0xFFU);
            int const b = static_cast<int>(below.pixels()[i] >> shift & 0xFFU);
            ASSERT_NEAR(a, b, 3) << i << ", " << shift;
        }
    }
}

TEST(Canvas, WithoutMemoryForANewSizeIsEmpty) {
    constexpr int kMost = std::numeric_limits<int>::max();
    Canvas canvas({10, 10});
    EXPECT_THROW(canvas.resize({kMost, kMost}), std::length_error);
    EXPECT_EQ(canvas.size(), (PictureSize{0, 0}));
    canvas.resize({20, 5});
    EXPECT_EQ(canvas.pixels().size(), 100U);
}

TEST(Canvas, HoldsAWidePicture) {
    Canvas canvas({16384, 100});
    Coverage coverage;
    draw_everything(canvas, {8000.0F, 50.0F}, 20000.0F, coverage);
    EXPECT_EQ(canvas.pixels().back(), kWhite);
}

}  // namespace
}  // namespace pogosim
