#include "base/escaped.hpp"

#include <gtest/gtest.h>

#include <string>

namespace pogosim {
namespace {

TEST(EscapedText, IsOneLineThatSteersNoTerminal) {
    EXPECT_EQ(escaped("one\ntwo\r\tthree"), "one\\ntwo\\r\\tthree");
    EXPECT_EQ(escaped("\x1b[2J\x7f"), "\\x1b[2J\\x7f");
    EXPECT_EQ(escaped(std::string("a\0b", 3)), "a\\x00b");
    EXPECT_EQ(escaped("\xC2\x9B"
                      "2J"),
              "\\xc2\\x9b2J");
}

TEST(EscapedText, KeepsTextOfAllLanguages) {
    EXPECT_EQ(escaped("\xC3\xA9t\xC3\xA9 \xE2\x9C\x93 'C:\\new'"), "\xC3\xA9t\xC3\xA9 \xE2\x9C\x93 'C:\\new'");
    EXPECT_EQ(escaped("\xC2\xA0"), "\xC2\xA0");
}

TEST(EscapedText, ShowsTheBytesOfWhatIsNotText) {
    EXPECT_EQ(escaped("caf\xE9.csv"), "caf\\xe9.csv");
    EXPECT_EQ(escaped("\xE2\x9C"), "\\xe2\\x9c");
}

TEST(EscapedText, DoesNotChangeWhenEscapedAgain) {
    EXPECT_EQ(escaped(escaped("one\ntwo\xFF")), escaped("one\ntwo\xFF"));
}

}  // namespace
}  // namespace pogosim
