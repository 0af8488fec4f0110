#include "geometry/outline_survey.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "base/random.hpp"

namespace pogosim {
namespace {

bool crosses(std::vector<Polygon> const& polygons) {
    return survey_outlines(polygons).crossing.has_value();
}

Polygon square(float x, float y, float side) {
    return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

/// Corners on whole numbers, so that the reference below is exact.
Polygon random_polygon(RandomStream& random, std::uint32_t corners, std::uint32_t side) {
    Polygon polygon;
    for (std::uint32_t i = 0; i < corners; ++i) {
        auto const x = static_cast<float>(random.below(side));
        auto const y = static_cast<float>(random.below(side));
        polygon.push_back({x, y});
    }
    return polygon;
}

int orientation(Vec2 a, Vec2 b, Vec2 c) {
    float const turn = cross(b - a, c - a);
    return (turn > 0.0F ? 1 : 0) - (turn < 0.0F ? 1 : 0);
}

bool is_on(Vec2 a, Vec2 b, Vec2 p) {
    return orientation(a, b, p) == 0 && dot(p - a, p - b) <= 0.0F;
}

bool segments_touch(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    bool const proper =
        orientation(a, b, c) * orientation(a, b, d) < 0 && orientation(c, d, a) * orientation(c, d, b) < 0;
    return proper || is_on(a, b, c) || is_on(a, b, d) || is_on(c, d, a) || is_on(c, d, b);
}

bool edges_touch(std::vector<Polygon> const& polygons, EdgeOf e, EdgeOf f) {
    Polygon const& p = polygons[e.polygon];
    Polygon const& q = polygons[f.polygon];
    return segments_touch(p[e.edge], p[(e.edge + 1) % p.size()], q[f.edge], q[(f.edge + 1) % q.size()]);
}

/// Tries every pair of edges.
bool crosses_by_brute_force(std::vector<Polygon> const& polygons) {
    std::vector<EdgeOf> edges;
    for (std::size_t p = 0; p < polygons.size(); ++p) {
        for (std::size_t i = 0; i < polygons[p].size(); ++i) {
            edges.push_back({p, i});
        }
    }
    for (EdgeOf const e : edges) {
        for (EdgeOf const f : edges) {
            std::size_t const count = polygons[e.polygon].size();
            bool const neighbours =
                e.polygon == f.polygon && ((e.edge + 1) % count == f.edge || (f.edge + 1) % count == e.edge);
            if (e != f && !neighbours && edges_touch(polygons, e, f)) {
                return true;
            }
        }
    }
    return false;
}

TEST(OutlineSurvey, ConvexAndConcavePolygonsDoNotCross) {
    EXPECT_FALSE(crosses({square(0, 0, 1)}));
    EXPECT_FALSE(crosses({{{0, 0}, {1, 0}, {0, 1}}}));
    EXPECT_FALSE(crosses({{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}}));
}

TEST(OutlineSurvey, CornersInTheMiddleOfStraightEdgesAreFine) {
    EXPECT_FALSE(crosses({{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}}));
}

TEST(OutlineSurvey, BowTieNamesItsTwoCrossingEdges) {
    std::vector<Polygon> const bow_tie{{{0, 0}, {2, 2}, {2, 0}, {0, 2}}};
    auto const crossing = survey_outlines(bow_tie).crossing;
    ASSERT_TRUE(crossing);
    EXPECT_EQ(crossing->first, (EdgeOf{0, 0}));
    EXPECT_EQ(crossing->second, (EdgeOf{0, 2}));
}

TEST(OutlineSurvey, CornerOnAnotherEdgeIsATouch) {
    EXPECT_TRUE(crosses({{{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}}));
}

TEST(OutlineSurvey, TwoCornersAtOnePlaceAreATouch) {
    EXPECT_TRUE(crosses({{{0, 0}, {2, 1}, {4, 0}, {4, 3}, {2, 1}, {0, 3}}}));
}

TEST(OutlineSurvey, EdgeThatFoldsBackOnItselfIsATouch) {
    EXPECT_TRUE(crosses({{{0, 0}, {10, 0}, {5, 0}, {5, 5}}}));
    EXPECT_TRUE(crosses({{{0, 0}, {0, 10}, {0, 5}, {5, 5}}}));
}

TEST(OutlineSurvey, NestedSquaresDoNotCrossAndOverlappingOnesDo) {
    EXPECT_FALSE(crosses({square(0, 0, 10), square(2, 2, 3)}));
    EXPECT_FALSE(crosses({square(0, 0, 10), square(20, 0, 3)}));
    EXPECT_TRUE(crosses({square(0, 0, 10), square(8, 8, 5)}));
    EXPECT_TRUE(crosses({square(0, 0, 10), square(0, 0, 10)}));
    EXPECT_TRUE(crosses({square(0, 0, 10), square(0, 2, 3)}));
    EXPECT_TRUE(crosses({square(0, 0, 10), square(10, 10, 3)}));
}

TEST(OutlineSurvey, EveryPolygonKnowsTheInnermostOneAroundIt) {
    std::vector<Polygon> polygons{square(5, 5, 2), square(0, 0, 20), square(4, 4, 10), square(15, 15, 2),
                                  square(30, 0, 1)};
    for (int winding = 0; winding < 2; ++winding) {
        auto const parent = survey_outlines(polygons).parent;
        EXPECT_EQ(parent[0], 2U);
        EXPECT_EQ(parent[1], std::nullopt);
        EXPECT_EQ(parent[2], 1U);
        EXPECT_EQ(parent[3], 1U);
        EXPECT_EQ(parent[4], std::nullopt);
        for (Polygon& polygon : polygons) {
            std::swap(polygon[1], polygon[3]);
        }
    }
}

TEST(OutlineSurvey, AgreesWithTryingEveryPairOfEdges) {
    RandomStream random(7, 0);
    int crossing = 0;
    constexpr int trials = 20000;
    for (int trial = 0; trial < trials; ++trial) {
        std::uint32_t const side = 4 + random.below(20);
        std::vector<Polygon> polygons{random_polygon(random, 4 + random.below(3), side)};
        if (trial % 2 == 0) {
            polygons.push_back(random_polygon(random, 4, side));
        }
        bool const expected = crosses_by_brute_force(polygons);
        auto const found = survey_outlines(polygons).crossing;
        ASSERT_EQ(found.has_value(), expected) << "trial " << trial;
        if (found && found->first.polygon == found->second.polygon) {
            // A repeated corner is reported by the edges that start there.
            Polygon const& p = polygons[found->first.polygon];
            EXPECT_TRUE(edges_touch(polygons, found->first, found->second) ||
                        p[found->first.edge] == p[found->second.edge]);
        }
        crossing += expected ? 1 : 0;
    }
    EXPECT_GT(crossing, trials / 10);
    EXPECT_LT(crossing, trials - trials / 50);
}

TEST(OutlineSurvey, HundredThousandCornersAreSurveyed) {
    // A comb of long slanted teeth, whose bounding boxes all overlap.
    Polygon comb;
    constexpr int teeth = 25000;
    for (int i = 0; i < teeth; ++i) {
        auto const x = static_cast<float>(4 * i);
        comb.insert(comb.end(), {{x, 0.0F}, {x + 200000.0F, 200000.0F}, {x + 200002.0F, 200000.0F}, {x + 2.0F, 0.0F}});
    }
    comb.push_back({4.0F * teeth, -10.0F});
    comb.push_back({-10.0F, -10.0F});
    EXPECT_FALSE(crosses({comb}));
}

}  // namespace
}  // namespace pogosim
