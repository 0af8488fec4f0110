// Text in JSON.
#include "base/escaped.hpp"

#include <gtest/gtest.h>

namespace pogosim {
namespace {

TEST(JsonText, EscapesWhatIsReservedAndKeepsAllElse) {
    EXPECT_EQ(json_text("robots"), "\"robots\"");
    EXPECT_EQ(json_text(""), "\"\"");
    EXPECT_EQ(json_text("a \"b\" \\ c/d"), R"("a \"b\" \\ c/d")");
    EXPECT_EQ(json_text("\n\t\x01"), R"("\u000a\u0009\u0001")");
    EXPECT_EQ(json_text("\xC3\xA9\xF0\x9F\xA4\x96"), "\"\xC3\xA9\xF0\x9F\xA4\x96\"");
}

}  // namespace
}  // namespace pogosim
