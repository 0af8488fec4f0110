#include "base/nearest_name.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace pogosim {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsAndSubstitutions) {
    EXPECT_EQ(edit_distance("radius", "radius"), 0U);
    EXPECT_EQ(edit_distance("radus", "radius"), 1U);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
    EXPECT_EQ(edit_distance("", "abc"), 3U);
    EXPECT_EQ(edit_distance("gui", "GUI"), 0U);
}

TEST(NearestName, IsTheOneWithTheFewestChanges) {
    std::array<std::string, 3> const known{"radius", "body_radius", "nb"};
    EXPECT_EQ(nearest_name("radus", known), "radius");
    EXPECT_EQ(nearest_name("bodyradius", known), "body_radius");
}

TEST(NearestName, IsEmptyWhenNothingIsClose) {
    std::array<std::string, 2> const known{"radius", "nb"};
    EXPECT_EQ(nearest_name("temperature", known), "");
    EXPECT_EQ(nearest_name("x", known), "");
    EXPECT_EQ(nearest_name("b", known), "");
}

TEST(DidYouMean, NamesTheOneWhoseUnitIsMissing) {
    std::array<std::string, 4> const known{"angle_deg", "linear_mm_s", "wall_mm", "wall_deg"};
    EXPECT_EQ(did_you_mean("angle", known), "; did you mean 'angle_deg'?");
    EXPECT_EQ(did_you_mean("linear", known), "; did you mean 'linear_mm_s'?");
    EXPECT_EQ(did_you_mean("wall", known), "");
    EXPECT_EQ(did_you_mean("", known), "");
}

TEST(NearestName, IsNotALongNameInWhichAWordIsAnother) {
    std::array<std::string, 2> const known{"turn_duration_ms", "body_linear_damping"};
    EXPECT_EQ(nearest_name("run_duration_min", known), "");
    EXPECT_EQ(nearest_name("tumble_duration_max", known), "");
    EXPECT_EQ(nearest_name("body_angular_damping", known), "");
    EXPECT_EQ(nearest_name("turn_duraton_ms", known), "turn_duration_ms");
}

}  // namespace
}  // namespace pogosim
