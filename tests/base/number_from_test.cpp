#include "base/number_from.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pogosim {
namespace {

TEST(NumberFrom, TextThatIsNoNumberAsAWholeIsNone) {
    EXPECT_DOUBLE_EQ(number_from("-2.5e3"), -2500.0);
    EXPECT_TRUE(std::isinf(number_from("1e400")));
    EXPECT_EQ(number_from("1e-400"), 0.0);  // as in YAML and in Python: the nearest number there is
    for (auto const* text : {"", "one", "1,5", "1 "}) {
        EXPECT_TRUE(std::isnan(number_from(text))) << text;
    }
}

TEST(NumberFrom, TheDecimalNumberAtTheStartOfATextEndsBeforeWhatIsNotOfIt) {
    EXPECT_EQ(decimal_at_start("12"), "12");
    EXPECT_EQ(decimal_at_start("-1.5e-3 and more"), "-1.5e-3");
    EXPECT_EQ(decimal_at_start(".5"), ".5");
    EXPECT_EQ(decimal_at_start("5."), "5.");
    EXPECT_EQ(decimal_at_start("1E+6)"), "1E+6");
    EXPECT_EQ(decimal_at_start("3east"), "3");
    EXPECT_EQ(decimal_at_start("3e+"), "3");
    EXPECT_EQ(decimal_at_start("0x10"), "0");
    for (auto const* text : {"", ".", "-", "+1", "-.e1", " 1", "inf", "nan"}) {
        EXPECT_EQ(decimal_at_start(text), "") << text;
    }
}

}  // namespace
}  // namespace pogosim
