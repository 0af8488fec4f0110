#include "base/utf8.hpp"

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
        CodePoint const decoded = first_code_point(text + "x");
        ASSERT_EQ(decoded.bytes, exists ? text.size() : 0) << std::hex << code_point;
        ASSERT_EQ(decoded.value, exists ? code_point : kReplacementCharacter) << std::hex << code_point;
        ASSERT_EQ(well_formed_prefix(text), exists ? text.size() : 0) << std::hex << code_point;
    }
}

/// The sequence of `length` bytes that gives `code_point`, be it too long for it or not.
std::string encoded_in(std::size_t length, unsigned code_point) {
    std::string text(length, '\0');
    for (std::size_t i = length - 1; i > 0; --i) {
        text[i] = static_cast<char>(0x80 | (code_point & 0x3F));
        code_point >>= 6;
    }
    unsigned const lead = length == 2 ? 0xC0 : length == 3 ? 0xE0 : 0xF0;
    text[0] = static_cast<char>(lead | code_point);
    return text;
}

TEST(Utf8, OverlongFormsAreMalformedInEveryByte) {
    for (std::size_t length = 2; length <= 4; ++length) {
        unsigned const shortest = length == 2 ? 0x80 : length == 3 ? 0x800 : 0x10000;  // that needs this length
        for (unsigned code_point = 0; code_point < shortest; ++code_point) {
            ASSERT_EQ(first_code_point(encoded_in(length, code_point)).bytes, 0U) << std::hex << code_point;
        }
        ASSERT_EQ(first_code_point(encoded_in(length, shortest)).bytes, length);
    }
    EXPECT_EQ(replace_malformed("\xE0\x80\xAF"), kMark + kMark + kMark);  // '/' in three bytes
    EXPECT_EQ(replace_malformed("\xF0\x80\x80\xAF"), kMark + kMark + kMark + kMark);
}

TEST(Utf8, SurrogatesAndWhatIsAboveTheLastCodePointAreMalformedInEveryByte) {
    EXPECT_EQ(replace_malformed("\xED\xA0\x80"), kMark + kMark + kMark);
    EXPECT_EQ(replace_malformed("\xED\xBF\xBF"), kMark + kMark + kMark);
    EXPECT_EQ(replace_malformed("\xF4\x90\x80\x80"), kMark + kMark + kMark + kMark);
    EXPECT_EQ(replace_malformed("\xF8\x88\x80\x80\x80"), kMark + kMark + kMark + kMark + kMark);
}

TEST(Utf8, TextsCutAnywhereInsideACharacterAreMalformedThere) {
    for (unsigned const code_point : {0x80U, 0x7FFU, 0x800U, 0xFFFDU, 0x10000U, 0x10FFFFU}) {
        std::string const text = encoded(code_point);
        for (std::size_t kept = 0; kept < text.size(); ++kept) {
            ASSERT_EQ(first_code_point(text.substr(0, kept)).bytes, 0U) << std::hex << code_point;
            ASSERT_EQ(well_formed_prefix("a" + text.substr(0, kept)), 1U) << std::hex << code_point;
            ASSERT_EQ(well_formed_prefix("a" + text.substr(0, kept) + "b"), kept == 0 ? 2U : 1U)
                << std::hex << code_point;
        }
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
