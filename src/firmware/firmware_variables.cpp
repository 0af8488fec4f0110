#include "firmware/firmware_variables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/nearest_name.hpp"
#include "base/utf8.hpp"

namespace pogosim {

namespace {

using Kind = VariableType::Kind;

constexpr std::string_view kUserDataOfRobots = "myuserdata";  // what `mydata` of programs is on robots
constexpr std::string_view kUserData = "mydata";

bool is_text(VariableType const& type) {
    return type.kind == Kind::array && type.element->kind == Kind::text;
}

bool is_number(VariableType const& type) {
    switch (type.kind) {
        case Kind::boolean:
        case Kind::signed_number:
        case Kind::unsigned_number:
        case Kind::text:
        case Kind::enumeration:
        case Kind::pointer:
            return type.bytes >= 1 && type.bytes <= 8;
        case Kind::floating:
            return type.bytes == sizeof(float) || type.bytes == sizeof(double);
        default:
            return false;
    }
}

/// Whether a number may be below 0. A char may not, on robots.
bool has_sign(VariableType const& type) {
    bool const is_signed_enumeration =
        type.kind == Kind::enumeration && (type.element == nullptr || type.element->kind == Kind::signed_number);
    return type.kind == Kind::signed_number || is_signed_enumeration;
}

/// The first part of a path, and the rest behind a dot or a bracket.
struct Split {
    std::string_view first;
    std::string_view rest;
};

Split split(std::string_view path) {
    std::size_t const end = std::min(path.find_first_of(".[", 1), path.size());
    return {path.substr(0, end), path.substr(end)};
}

std::optional<std::size_t> index_in(std::string_view part) {
    std::size_t index = 0;
    char const* const end = part.data() + part.size() - 1;
    bool const is_closed = part.size() > 2 && part.back() == ']';
    if (!is_closed) {
        return std::nullopt;
    }
    auto const [read_to, error] = std::from_chars(part.data() + 1, end, index);
    return error == std::errc() && read_to == end ? std::optional(index) : std::nullopt;
}

/// What is at `path`, such as ".pose[1].x", in a variable. `why`: why there is nothing, if that can be said.
std::optional<FirmwareVariable> part_of(FirmwareVariable variable, std::string_view path, std::string& why) {
    while (!path.empty()) {
        auto const [part, rest] = split(path);
        if (part.front() == '[') {
            auto const index = index_in(part);
            if (variable.type->kind == Kind::array && index && *index >= variable.type->count) {
                why = fmt::format("{} is beyond its end: it has {} elements", part, variable.type->count);
                return std::nullopt;
            }
            if (variable.type->kind != Kind::array || !index) {
                return std::nullopt;
            }
            VariableTypePointer const element = variable.type->element;
            variable = {variable.address + static_cast<std::uint32_t>(*index * element->bytes), element};
        } else {
            auto const& members = variable.type->members;
            auto const member = std::ranges::find(members, part.substr(1), &VariableType::Member::name);
            if (member == members.end()) {
                return std::nullopt;
            }
            if (member->bits > 0) {
                why = fmt::format("{} is a bit field, which cannot be a column; keep a copy in a variable of its own",
                                  escaped(member->name));
                return std::nullopt;
            }
            variable = {variable.address + static_cast<std::uint32_t>(member->offset), member->type};
        }
        path = rest;
    }
    return variable;
}

std::string name_of_variable(ProgramVariables::Variable const& variable) {
    return variable.name == kUserDataOfRobots ? std::string(kUserData) : variable.name;
}

void add_names(std::string const& name, VariableType const& type, std::vector<std::string>& names) {
    constexpr std::size_t most_names = 2000;
    if (names.size() > most_names) {
        return;
    }
    names.push_back(name);
    for (VariableType::Member const& member : type.members) {
        add_names(name + "." + member.name, *member.type, names);
    }
}

std::uint64_t bits_at(FirmwareVariable const& variable, Memory const& memory) {
    std::array<std::byte, 8> bytes{};
    memory.read(variable.address, std::span(bytes).first(variable.type->bytes));
    return read_little_endian<4>(bytes.data()) | std::uint64_t{read_little_endian<4>(&bytes[4])} << 32U;
}

std::string text_at(FirmwareVariable const& variable, Memory const& memory) {
    std::string text(variable.type->bytes, '\0');
    memory.read(variable.address, std::as_writable_bytes(std::span(text)));
    return replace_malformed(text.substr(0, text.find('\0')));
}

}  // namespace

FirmwareVariables::FirmwareVariables(FirmwareProgram const& program)
    : file_(escaped(program.file)),
      variables_(variables_in_file(program.file, [image = program.firmware.image](std::uintptr_t address) {
          return address - image->address < image->bytes.size();
      })) {}

void FirmwareVariables::fail(std::string const& what) const {
    throw ConfigError(fmt::format("{}: {}", file_, what));
}

FirmwareVariable FirmwareVariables::find(std::string const& name) const {
    if (!variables_.why_unknown.empty()) {
        fail(fmt::format("column '{}': {}", escaped(name), variables_.why_unknown));
    }
    auto const [first, rest] = split(name);
    std::string why;
    for (ProgramVariables::Variable const& variable : variables_.own) {
        if (name_of_variable(variable) != first && variable.name != first) {
            continue;
        }
        auto const part = part_of({static_cast<std::uint32_t>(variable.address), variable.type}, rest, why);
        if (part && (is_number(*part->type) || is_text(*part->type))) {
            return *part;
        }
        if (part) {
            fail(fmt::format("column '{}': is neither a number nor a text; name one of its parts", escaped(name)));
        }
    }
    if (!why.empty()) {
        fail(fmt::format("column '{}': {}", escaped(name), why));
    }
    std::vector<std::string> names;
    for (ProgramVariables::Variable const& variable : variables_.own) {
        if (variable.name.ends_with(fmt::format(": {}", first))) {
            fail(fmt::format("column '{}': several variables have this name, such as '{}'; rename one", escaped(name),
                             escaped(variable.name)));
        }
        add_names(name_of_variable(variable), *variable.type, names);
    }
    fail(fmt::format("column '{}': the program has no such variable{}; the compiler leaves out what does not change",
                     escaped(name), did_you_mean(name, names)));
}

NamedTexts FirmwareVariables::texts(Memory const& memory) const {
    NamedTexts texts;
    std::vector<std::byte> bytes;
    for (ProgramVariables::Variable const& variable : variables_.own) {
        bytes.resize(variable.type->bytes);
        memory.read(static_cast<std::uint32_t>(variable.address), bytes);
        add_texts(variable.name == kUserDataOfRobots ? "" : variable.name, *variable.type, bytes, texts);
    }
    return texts;
}

ColumnType column_type_of(VariableType const& type) {
    if (is_text(type)) {
        return ColumnType::text;
    }
    if (type.kind == Kind::boolean) {
        return ColumnType::boolean;
    }
    if (type.kind == Kind::floating) {
        return type.bytes == sizeof(float) ? ColumnType::float32 : ColumnType::float64;
    }
    std::size_t const bytes = has_sign(type) ? type.bytes : 2 * type.bytes;
    return bytes <= 1   ? ColumnType::int8
           : bytes <= 2 ? ColumnType::int16
           : bytes <= 4 ? ColumnType::int32
                        : ColumnType::int64;
}

CellValue value_of(FirmwareVariable const& variable, Memory const& memory) {
    VariableType const& type = *variable.type;
    if (is_text(type)) {
        return text_at(variable, memory);
    }
    std::uint64_t const bits = bits_at(variable, memory);
    if (type.kind == Kind::boolean) {
        return bits != 0;
    }
    if (type.kind == Kind::floating) {
        return type.bytes == sizeof(float) ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                                           : std::bit_cast<double>(bits);
    }
    unsigned const unused = has_sign(type) ? 64 - 8 * static_cast<unsigned>(type.bytes) : 0;
    return static_cast<std::int64_t>(bits << unused) >> unused;
}

}  // namespace pogosim
