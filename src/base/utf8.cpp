#include "base/utf8.hpp"

#include <algorithm>
#include <array>

namespace pogosim {

namespace {

/// Sequences by lead byte: their length, and what the second byte may be (later ones are 0x80 to 0xBF).
struct SequenceRule {
    unsigned char lead_min, lead_max;
    std::size_t length;
    unsigned char second_min, second_max;
};

constexpr std::array<SequenceRule, 9> kRules{{
    {0x00, 0x7F, 1, 0x00, 0x00},
    {0xC2, 0xDF, 2, 0x80, 0xBF},
    {0xE0, 0xE0, 3, 0xA0, 0xBF},
    {0xE1, 0xEC, 3, 0x80, 0xBF},
    {0xED, 0xED, 3, 0x80, 0x9F},
    {0xEE, 0xEF, 3, 0x80, 0xBF},
    {0xF0, 0xF0, 4, 0x90, 0xBF},
    {0xF1, 0xF3, 4, 0x80, 0xBF},
    {0xF4, 0xF4, 4, 0x80, 0x8F},
}};

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

}  // namespace

CodePoint first_code_point(std::string_view text) {
    if (text.empty()) {
        return {};
    }
    auto const byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    auto const* const rule = std::find_if(kRules.begin(), kRules.end(), [&](SequenceRule const& candidate) {
        return byte(0) >= candidate.lead_min && byte(0) <= candidate.lead_max;
    });
    if (rule == kRules.end() || text.size() < rule->length) {
        return {};
    }
    if (rule->length == 1) {
        return {byte(0), 1};
    }
    if (byte(1) < rule->second_min || byte(1) > rule->second_max) {
        return {};
    }
    // The lead byte starts with as many ones as there are bytes, and a zero; each further byte adds six bits.
    char32_t value = byte(0) & (0x7FU >> rule->length);
    for (std::size_t i = 1; i < rule->length; ++i) {
        if (byte(i) < 0x80 || byte(i) > 0xBF) {
            return {};
        }
        value = (value << 6U) | (byte(i) & 0x3FU);
    }
    return {value, rule->length};
}

std::size_t well_formed_prefix(std::string_view text) {
    std::size_t good = 0;
    while (good < text.size()) {
        std::size_t const length = first_code_point(text.substr(good)).bytes;
        if (length == 0) {
            break;
        }
        good += length;
    }
    return good;
}

std::string replace_malformed(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        std::size_t const good = well_formed_prefix(text);
        result += text.substr(0, good);
        text.remove_prefix(good);
        if (!text.empty()) {
            result += kReplacement;
            text.remove_prefix(1);
        }
    }
    return result;
}

}  // namespace pogosim
