#include "process/variable_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "base/escaped.hpp"
#include "base/utf8.hpp"

namespace pogosim {

namespace {

using Kind = VariableType::Kind;

constexpr std::size_t kMostElements = 8;   // of an array, shown
constexpr std::size_t kMostMembers = 8;    // of a structure on one line
constexpr std::size_t kMostLines = 400;    // of all variables
constexpr std::size_t kLongestText = 300;  // of an array or a structure, beyond which nothing is added
constexpr std::size_t kLargestNumber = 8;  // bytes

/// The first `bytes` of a number in memory, the lowest first.
std::uint64_t bits_of(std::span<std::byte const> bytes) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, bytes.data(), std::min(bytes.size(), kLargestNumber));
    return bits;
}

std::int64_t with_sign(std::uint64_t bits, unsigned width) {
    unsigned const unused = 64 - width;
    return static_cast<std::int64_t>(bits << unused) >> unused;
}

std::string number_text(VariableType const& type, std::uint64_t bits, unsigned width) {
    switch (type.kind) {
        case Kind::boolean:
            return bits == 0 ? "false" : "true";
        case Kind::signed_number:
            return fmt::format("{}", with_sign(bits, width));
        case Kind::text:
            return fmt::format("{} '{}'", with_sign(bits, width), escaped(std::string(1, static_cast<char>(bits))));
        case Kind::enumeration: {
            auto const has_value = [&](auto const& constant) {
                return constant.first == with_sign(bits, width) || static_cast<std::uint64_t>(constant.first) == bits;
            };
            auto const found = std::ranges::find_if(type.constants, has_value);
            return found != type.constants.end() ? found->second : fmt::format("{}", with_sign(bits, width));
        }
        case Kind::pointer:
            return bits == 0 ? "null" : fmt::format("{:#x}", bits);
        default:
            return fmt::format("{}", bits);
    }
}

std::string floating_text(std::span<std::byte const> bytes) {
    if (bytes.size() == sizeof(float)) {
        float number = 0.0F;
        std::memcpy(&number, bytes.data(), sizeof(number));
        return fmt::format("{:g}", number);
    }
    if (bytes.size() == sizeof(double)) {
        double number = 0.0;
        std::memcpy(&number, bytes.data(), sizeof(number));
        return fmt::format("{:.8g}", number);
    }
    long double number = 0.0L;
    std::memcpy(&number, bytes.data(), std::min(bytes.size(), sizeof(number)));
    return fmt::format("{:.8g}", static_cast<double>(number));
}

std::string array_text(VariableType const& type, std::span<std::byte const> bytes) {
    VariableType const& element = *type.element;
    if (element.kind == Kind::text) {
        std::string_view const text(reinterpret_cast<char const*>(bytes.data()), bytes.size());
        return fmt::format("\"{}\"", escaped(replace_malformed(std::string(text.substr(0, text.find('\0'))))));
    }
    std::string text;
    std::size_t shown = 0;
    for (; shown < std::min(type.count, kMostElements) && text.size() < kLongestText; ++shown) {
        std::string const value = value_text(element, bytes.subspan(shown * element.bytes, element.bytes));
        text +=
            fmt::format(fmt::runtime(element.kind == Kind::array ? "{}[{}]" : "{}{}"), shown > 0 ? ", " : "", value);
    }
    return shown < type.count ? fmt::format("{}, ... ({})", text, type.count) : text;
}

std::string member_text(VariableType::Member const& member, std::span<std::byte const> bytes) {
    if (member.offset >= bytes.size()) {
        return "?";
    }
    if (member.bits == 0) {
        return value_text(*member.type, bytes.subspan(member.offset));
    }
    std::uint64_t const bits = bits_of(bytes.subspan(member.offset)) >> member.first_bit;
    return number_text(*member.type, member.bits < 64 ? bits & ((std::uint64_t{1} << member.bits) - 1) : bits,
                       std::min(member.bits, 64U));
}

std::string structure_text(VariableType const& type, std::span<std::byte const> bytes) {
    std::string text;
    std::size_t shown = 0;
    for (; shown < std::min(type.members.size(), kMostMembers) && text.size() < kLongestText; ++shown) {
        VariableType::Member const& member = type.members[shown];
        text += fmt::format("{}{}: {}", shown > 0 ? ", " : "", member.name, member_text(member, bytes));
    }
    return fmt::format("{{{}{}}}", text, shown < type.members.size() ? ", ..." : "");
}

}  // namespace

std::string value_text(VariableType const& type, std::span<std::byte const> bytes) {
    if (bytes.size() < type.bytes) {
        return "?";
    }
    bytes = bytes.first(type.bytes);
    switch (type.kind) {
        case Kind::unknown:
            return fmt::format("({} bytes)", type.bytes);
        case Kind::floating:
            return floating_text(bytes);
        case Kind::array:
            return array_text(type, bytes);
        case Kind::structure:
            return structure_text(type, bytes);
        default:
            return type.bytes <= kLargestNumber
                       ? number_text(type, bits_of(bytes), static_cast<unsigned>(8 * type.bytes))
                       : fmt::format("({} bytes)", type.bytes);
    }
}

void add_texts(std::string const& name, VariableType const& type, std::span<std::byte const> bytes, NamedTexts& texts) {
    if (texts.size() >= kMostLines) {
        return;
    }
    if (type.kind != Kind::structure) {
        texts.emplace_back(name, value_text(type, bytes));
        return;
    }
    for (VariableType::Member const& member : type.members) {
        std::string const full_name = name.empty() ? member.name : name + "." + member.name;
        if (member.bits == 0 && member.offset <= bytes.size()) {
            add_texts(full_name, *member.type, bytes.subspan(member.offset), texts);
        } else if (texts.size() < kMostLines) {
            texts.emplace_back(full_name, member_text(member, bytes));
        }
    }
}

}  // namespace pogosim
