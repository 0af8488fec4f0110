#include "process/program_variables.hpp"

#ifdef POGOSIM_HAS_LIBDW
#include <dwarf.h>
#include <elfutils/libdw.h>

#include "debug_info/entries.hpp"
#endif

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "base/escaped.hpp"

namespace pogosim {

#ifdef POGOSIM_HAS_LIBDW

namespace {

using Kind = VariableType::Kind;

constexpr int kDeepest = 16;        // levels of types within types
constexpr int kMostTypes = 20'000;  // of one variable: damaged debug information may say that a type contains itself

thread_local int types_left = 0;  // of the variable that is read

using shared_state::for_each_child;

std::string name_of(Dwarf_Die& entry) {
    return escaped(shared_state::name_of(&entry));
}

std::optional<std::uint64_t> number(Dwarf_Die& entry, unsigned name) {
    Dwarf_Attribute attribute;
    Dwarf_Word value = 0;
    bool const found = dwarf_attr_integrate(&entry, name, &attribute) != nullptr;
    return found && dwarf_formudata(&attribute, &value) == 0 ? std::optional<std::uint64_t>(value) : std::nullopt;
}

/// The type that an entry refers to, without typedefs and qualifiers.
std::optional<Dwarf_Die> type_behind(Dwarf_Die& entry) {
    Dwarf_Attribute attribute;
    Dwarf_Die type;
    Dwarf_Die bare;
    bool const found = dwarf_attr_integrate(&entry, DW_AT_type, &attribute) != nullptr &&
                       dwarf_formref_die(&attribute, &type) != nullptr && dwarf_peel_type(&type, &bare) == 0;
    return found ? std::optional<Dwarf_Die>(bare) : std::nullopt;
}

std::size_t bytes_of(Dwarf_Die& type) {
    Dwarf_Word bytes = 0;
    return dwarf_aggregate_size(&type, &bytes) == 0 ? bytes : 0;
}

Kind kind_of_base_type(Dwarf_Die& type) {
    std::string const name = name_of(type);
    switch (number(type, DW_AT_encoding).value_or(0)) {
        case DW_ATE_boolean:
            return Kind::boolean;
        case DW_ATE_float:
            return Kind::floating;
        case DW_ATE_signed:
            return Kind::signed_number;
        case DW_ATE_unsigned:
            return Kind::unsigned_number;
        case DW_ATE_signed_char:
            return name == "char" ? Kind::text : Kind::signed_number;
        case DW_ATE_unsigned_char:
            return name == "char" ? Kind::text : Kind::unsigned_number;
        default:
            return Kind::unknown;
    }
}

VariableTypePointer read_type(Dwarf_Die& type, int depth);

VariableTypePointer type_of(Dwarf_Die& entry, int depth) {
    std::optional<Dwarf_Die> type = type_behind(entry);
    types_left = depth == 0 ? kMostTypes : types_left - 1;
    bool const is_read = type && depth < kDeepest && types_left > 0;
    return is_read ? read_type(*type, depth + 1) : std::make_shared<VariableType const>();
}

/// Sets the place of a bit field, in each of the ways in which compilers describe it.
void place_bits(Dwarf_Die& entry, VariableType::Member& member) {
    member.bits = static_cast<unsigned>(number(entry, DW_AT_bit_size).value_or(0));
    std::size_t first_bit = 8 * member.offset;
    if (auto const from_start = number(entry, DW_AT_data_bit_offset)) {
        first_bit = *from_start;
    } else if (auto const from_top = number(entry, DW_AT_bit_offset)) {
        std::size_t const stored_bytes = number(entry, DW_AT_byte_size).value_or(member.type->bytes);
        first_bit += 8 * stored_bytes - *from_top - member.bits;
    }
    member.offset = first_bit / 8;
    member.first_bit = first_bit % 8;
}

void add_members(Dwarf_Die& structure, std::size_t offset, int depth, std::vector<VariableType::Member>& members) {
    for_each_child(&structure, [&](Dwarf_Die& child) {
        int const tag = dwarf_tag(&child);
        bool const is_shared = dwarf_hasattr(&child, DW_AT_declaration) != 0 ||
                               dwarf_hasattr(&child, DW_AT_external) != 0;                       // static in C++
        bool const has_no_place = tag == DW_TAG_inheritance && number(child, DW_AT_virtuality);  // known when it runs
        bool const is_hidden = dwarf_hasattr(&child, DW_AT_artificial) != 0;  // the address of virtual functions
        if ((tag != DW_TAG_member && tag != DW_TAG_inheritance) || is_shared || has_no_place || is_hidden) {
            return;
        }
        VariableType::Member member{.name = name_of(child),
                                    .offset = number(child, DW_AT_data_member_location).value_or(0),
                                    .type = type_of(child, depth)};
        if (number(child, DW_AT_bit_size)) {
            place_bits(child, member);
        }
        member.offset += offset;
        if (!member.name.empty()) {
            members.push_back(std::move(member));
            return;
        }
        // The members of a base class, or of a structure without a name, count as members of this one.
        for (VariableType::Member inner : member.type->members) {
            inner.offset += member.offset;
            members.push_back(std::move(inner));
        }
    });
}

/// A class as it is shown: std::array as its only member; other classes of libraries are opaque.
VariableTypePointer as_read(VariableType type) {
    auto const is_inner = [](std::string const& name) { return name.starts_with("_M_") || name.starts_with("__"); };
    if (type.members.size() == 1 && type.members.front().type->kind == Kind::array &&
        is_inner(type.members.front().name)) {
        return type.members.front().type;
    }
    bool const is_of_library =
        std::ranges::any_of(type.members, [&](auto const& member) { return is_inner(member.name); });
    type.kind = is_of_library ? Kind::unknown : Kind::structure;
    return std::make_shared<VariableType const>(std::move(type));
}

VariableTypePointer array_of(Dwarf_Die& type, int depth) {
    std::vector<std::size_t> counts;
    for_each_child(&type, [&](Dwarf_Die& child) {
        if (dwarf_tag(&child) == DW_TAG_subrange_type) {
            auto const count = number(child, DW_AT_count);
            auto const last = number(child, DW_AT_upper_bound);
            counts.push_back(count ? *count : last ? *last + 1 : 0);
        }
    });
    VariableTypePointer element = type_of(type, depth);
    for (std::size_t i = counts.size(); i-- > 0;) {
        element = std::make_shared<VariableType const>(VariableType{
            .kind = Kind::array, .bytes = element->bytes * counts[i], .element = element, .count = counts[i]});
    }
    return element;
}

VariableTypePointer read_type(Dwarf_Die& type, int depth) {
    VariableType read{.bytes = bytes_of(type)};
    switch (dwarf_tag(&type)) {
        case DW_TAG_base_type:
            read.kind = kind_of_base_type(type);
            break;
        case DW_TAG_enumeration_type:
            read.kind = Kind::enumeration;
            read.element = dwarf_hasattr(&type, DW_AT_type) != 0 ? type_of(type, depth) : nullptr;
            for_each_child(&type, [&](Dwarf_Die& child) {
                Dwarf_Attribute attribute;
                Dwarf_Sword value = 0;
                if (dwarf_tag(&child) == DW_TAG_enumerator &&
                    dwarf_formsdata(dwarf_attr(&child, DW_AT_const_value, &attribute), &value) == 0) {
                    read.constants.emplace_back(value, name_of(child));
                }
            });
            break;
        case DW_TAG_pointer_type:
        case DW_TAG_reference_type:
        case DW_TAG_rvalue_reference_type:
            read.kind = Kind::pointer;
            read.bytes = read.bytes != 0 ? read.bytes : sizeof(void*);
            break;
        case DW_TAG_structure_type:
        case DW_TAG_class_type:
        case DW_TAG_union_type:
            add_members(type, 0, depth, read.members);
            return as_read(std::move(read));
        case DW_TAG_array_type:
            return array_of(type, depth);
        default:
            break;
    }
    return std::make_shared<VariableType const>(std::move(read));
}

/// The address of a variable, if it is the same for the whole run.
std::optional<std::uintptr_t> address_of(Dwarf_Die& variable) {
    Dwarf_Attribute location;
    Dwarf_Op* operations = nullptr;
    std::size_t count = 0;
    bool const is_one_place = dwarf_attr_integrate(&variable, DW_AT_location, &location) != nullptr &&
                              dwarf_getlocation(&location, &operations, &count) == 0 && count == 1;
    if (!is_one_place) {
        return std::nullopt;
    }
    if (operations->atom == DW_OP_addr) {
        return operations->number;
    }
    Dwarf_Attribute entry;
    Dwarf_Addr address = 0;
    bool const is_listed = operations->atom == DW_OP_addrx || operations->atom == DW_OP_GNU_addr_index;
    bool const found = is_listed && dwarf_getlocation_attr(&location, operations, &entry) == 0 &&
                       dwarf_formaddr(&entry, &address) == 0;
    return found ? std::optional<std::uintptr_t>(address) : std::nullopt;
}

class Reader {
public:
    /// `user_data_bytes`: of USERDATA as simulated programs have it; 0: there is none.
    Reader(std::function<bool(std::uintptr_t)> is_wanted, std::size_t user_data_bytes)
        : is_wanted_(std::move(is_wanted)), user_data_bytes_(user_data_bytes) {}

    ProgramVariables read(std::string const& path) {
        shared_state::DebugFile const file(path);
        shared_state::for_each_unit(file.debug_info(), [&](Dwarf_Die& entry) {
            unit_ = name_of(entry);
            unit_ = unit_.substr(unit_.find_last_of('/') + 1);
            look_into(entry, "");
        });
        tell_apart();
        if (read_.user_data == nullptr && (read_.own.empty() || user_data_bytes_ > 0)) {
            read_.why_unknown = "compile the program with -g to see its variables";
        }
        return std::move(read_);
    }

private:
    struct Found {
        ProgramVariables::Variable variable;
        std::string function;  // empty: outside of functions
        std::string unit;
    };

    void look_into(Dwarf_Die& entry, std::string const& function) {
        for_each_child(&entry, [&](Dwarf_Die& child) {
            switch (dwarf_tag(&child)) {
                case DW_TAG_variable:
                    add(child, function);
                    break;
                case DW_TAG_subprogram:
                    look_into(child, name_of(child));
                    break;
                case DW_TAG_namespace:
                case DW_TAG_lexical_block:
                    look_into(child, function);
                    break;
                default:
                    break;
            }
        });
    }

    void add(Dwarf_Die& variable, std::string const& function) {
        std::string const name = name_of(variable);
        if (name == "pogo_user_data_type" && user_data_bytes_ > 0) {
            add_user_data(variable);
            return;
        }
        auto const address = address_of(variable);
        if (!address || !is_wanted_(*address) || name.empty() || name.starts_with("pogo_user_data_") ||
            !seen_.emplace(*address, true).second) {
            return;
        }
        found_.push_back({{name, *address, type_of(variable, 0)}, function, unit_});
    }

    void add_user_data(Dwarf_Die& variable) {
        std::optional<Dwarf_Die> pointer = type_behind(variable);
        VariableTypePointer const type = pointer ? type_of(*pointer, 0) : nullptr;
        if (type != nullptr && type->bytes == user_data_bytes_) {
            read_.user_data = type;
        }
    }

    /// Puts the place of each variable in front of names that several have.
    void tell_apart() {
        std::map<std::string, int> count;
        for (Found const& found : found_) {
            ++count[found.variable.name];
        }
        for (Found& found : found_) {
            if (count[found.variable.name] > 1) {
                std::string const& place = found.function.empty() ? found.unit : found.function;
                found.variable.name = place + ": " + found.variable.name;
            }
            read_.own.push_back(std::move(found.variable));
        }
    }

    std::function<bool(std::uintptr_t)> is_wanted_;
    std::size_t user_data_bytes_;
    ProgramVariables read_;
    std::vector<Found> found_;
    std::map<std::uintptr_t, bool> seen_;  // addresses
    std::string unit_;
};

}  // namespace

ProgramVariables variables_of(ProgramImage const& image) {
    if (image.bytes_of_file().empty()) {
        return {.why_unknown =
                    "the program has been compiled again since this run began: restart it to see its variables"};
    }
    auto const is_own = [&image, pieces = image.memory_of_robots()](std::uintptr_t address) {
        return is_in_any(pieces, reinterpret_cast<void const*>(image.load_address + address));
    };
    return Reader(is_own, image.user_data_bytes).read(image.file.string());
}

ProgramVariables variables_in_file(std::string const& file, std::function<bool(std::uintptr_t)> is_wanted) {
    return Reader(std::move(is_wanted), 0).read(file);
}

#else

ProgramVariables variables_of(ProgramImage const& /*image*/) {
    return {.why_unknown = "this Pogosim was built without libdw, which reads variables"};
}

ProgramVariables variables_in_file(std::string const& /*file*/, std::function<bool(std::uintptr_t)> /*is_wanted*/) {
    return {.why_unknown = "this Pogosim was built without libdw, which reads variables"};
}

#endif

}  // namespace pogosim
