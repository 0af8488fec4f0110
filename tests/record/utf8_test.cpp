#include "record/utf8.hpp"

#include <gtest/gtest.h>

#include <string>

namespace pogosim {
namespace {

std::string const kMark = "\xEF\xBF\xBD";

/// The sequence that UTF-8 has for a code point, from its definition.
std::string encoded(unsigned code_point) {
    auto const tail = [code_point](int shift) { return static_cast<char>(0x80 | ((code_point >> shift) & 0x3F)); };
    if (code_point < 0x80) {
        return {static_cast<char>(code_point)};
    }
    if (code_point < 0x800) {
        return {static_cast<char>(0xC0 | (code_point >> 6)), tail(0)};
    }
    if (code_point < 0x10000) {
        return {static_cast<char>(0xE0 | (code_point >> 12)), tail(6), tail(0)};
    }
    return {static_cast<char>(0xF0 | (code_point >> 18)), tail(12), tail(6), tail(0)};
}

TEST(Utf8, EveryCodePointExceptSurrogatesIsWellFormed) {
    for (unsigned code_point = 0; code_point < 0x120000; ++code_point) {
        std::string const text = encoded(code_point);
        bool const surrogate = code_point >= 0xD800 && code_point < 0xE000;
        bool const exists = !surrogate && code_point <= 0x10FFFF;
        ASSERT_EQ(well_formed_prefix(text), exists ? text.size() : 0) << std::hex << code_point;
    }
}

TEST(Utf8, GoodTextStaysAsItIs) {
    std::string const text = "d\xC3\xA9j\xC3\xA0 vu, \xF0\x9F\xA4\x96";
    EXPECT_EQ(replace_malformed(text), text);
    EXPECT_EQ(replace_malformed(""), "");
}

TEST(Utf8, StrayTruncatedAndOverlongBytesAreMarkedAndTheRestSurvives) {
    EXPECT_EQ(replace_malformed("a\xFF"
                                "b"),
              "a" + kMark + "b");
    EXPECT_EQ(replace_malformed("a\x80"), "a" + kMark);
    EXPECT_EQ(replace_malformed("a\xC3"), "a" + kMark);
    EXPECT_EQ(replace_malformed("a\xE2\x82"), "a" + kMark + kMark);
    EXPECT_EQ(replace_malformed("\xC0\xAF"), kMark + kMark);
    EXPECT_EQ(replace_malformed("\xE2\x82\xAC\xE2(\xC3\xA9"), "\xE2\x82\xAC" + kMark + "(\xC3\xA9");
}

}  // namespace
}  // namespace pogosim
