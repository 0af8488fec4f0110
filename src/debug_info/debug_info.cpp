#include "debug_info/debug_info.hpp"

#include <dwarf.h>

#include <filesystem>

#include "debug_info/entries.hpp"

namespace shared_state {

namespace {

// The array that POGO_NOTE_CONFIGURED makes.
constexpr char const* note_name = "pogosim_configured";

std::string text_of(char const* text) {
    return text ? text : "";
}

// The entry that says what this one stands for: the declaration of a definition, the function of an inlined copy.
Dwarf_Die origin_of(Dwarf_Die entry) {
    for (unsigned const reference : {DW_AT_abstract_origin, DW_AT_specification, DW_AT_abstract_origin}) {
        Dwarf_Attribute attribute;
        Dwarf_Die origin;
        if (dwarf_attr(&entry, reference, &attribute) && dwarf_formref_die(&attribute, &origin)) {
            entry = origin;
        }
    }
    return entry;
}

bool flag(Dwarf_Die* entry, unsigned name) {
    Dwarf_Attribute attribute;
    bool set = false;
    return dwarf_attr_integrate(entry, name, &attribute) && dwarf_formflag(&attribute, &set) == 0 && set;
}

void read_type(Dwarf_Die* variable, Object& object) {
    Dwarf_Attribute attribute;
    Dwarf_Die type;
    if (!dwarf_attr_integrate(variable, DW_AT_type, &attribute) || !dwarf_formref_die(&attribute, &type)) {
        return;
    }
    Dwarf_Word bytes = 0;
    if (dwarf_aggregate_size(&type, &bytes) == 0) {
        object.bytes = bytes;
    }
    for (;;) {
        switch (dwarf_tag(&type)) {
            case DW_TAG_const_type:
                object.constant = true;
                break;
            case DW_TAG_typedef:
            case DW_TAG_volatile_type:
            case DW_TAG_restrict_type:
            case DW_TAG_atomic_type:
            case DW_TAG_array_type:
                break;  // an array is as constant as its elements
            case DW_TAG_reference_type:
            case DW_TAG_rvalue_reference_type:
                object.constant = true;
                return;
            case DW_TAG_pointer_type:
                object.pointer = true;
                return;
            case DW_TAG_structure_type:
            case DW_TAG_class_type:
            case DW_TAG_union_type:
                object.structure = true;
                return;
            default:
                return;
        }
        if (!dwarf_attr_integrate(&type, DW_AT_type, &attribute) || !dwarf_formref_die(&attribute, &type)) {
            return;
        }
    }
}

// The compiled file in which something was written. After link-time optimisation, that is where its origin is.
Scope unit_of(Dwarf_Die entry) {
    Dwarf_Die origin = origin_of(entry);
    Dwarf_Die unit;
    return dwarf_diecu(&origin, &unit, nullptr, nullptr) ? dwarf_dieoffset(&unit) : 0;
}

class Reader {
public:
    explicit Reader(ProgramFile const& program) : program_(program) {}

    DebugInfo read() {
        for_each_unit(program_.debug_info(), [&](Dwarf_Die& unit) { read_children(unit, nullptr); });
        for (auto& [address, object] : objects_) {
            info_.objects.push_back(std::move(object));
        }
        return std::move(info_);
    }

private:
    // `function`: the one that contains an entry, by its origin; null outside of functions.
    void read_children(Dwarf_Die& parent, Dwarf_Die* function) {
        for_each_child(&parent, [&](Dwarf_Die& entry) { read_entry(entry, function); });
    }

    void read_entry(Dwarf_Die& entry, Dwarf_Die* function) {
        switch (dwarf_tag(&entry)) {
            case DW_TAG_variable:
                read_variable(entry, function);
                break;
            case DW_TAG_formal_parameter:
                note_local(entry, function);
                break;
            case DW_TAG_subprogram:
            case DW_TAG_inlined_subroutine: {
                Dwarf_Die origin = origin_of(entry);
                read_children(entry, &origin);
                break;
            }
            default:
                read_children(entry, function);
        }
    }

    void note_local(Dwarf_Die& entry, Dwarf_Die* function) {
        if (function != nullptr && !flag(&entry, DW_AT_external)) {
            info_.local_to_a_call[dwarf_dieoffset(function)].insert(name_of(&entry));
        }
    }

    void read_variable(Dwarf_Die& entry, Dwarf_Die* function) {
        auto const address = address_of(&entry);
        if (!address) {
            // Without an address: automatic, or a declaration of what is elsewhere, or never needed by the program.
            note_local(entry, function);
            return;
        }
        std::string const name = name_of(&entry);
        Scope const function_scope = function != nullptr ? dwarf_dieoffset(function) : 0;
        if (name == note_name) {
            std::string const qualifier = function != nullptr ? qualifier_of(*function) : "";
            info_.notes.push_back({program_.text_at(*address), qualifier, function_scope, unit_of(entry)});
            return;
        }
        if (flag(&entry, DW_AT_artificial) || objects_.contains(*address) || !program_.section_at(*address).writable) {
            return;
        }
        Object object;
        object.name = name;
        object.qualifier = qualifier_of(entry);
        object.function = function != nullptr ? name_of(function) : "";
        object.function_scope = function_scope;
        object.unit = unit_of(entry);
        object.external = flag(&entry, DW_AT_external);
        object.file = file_of(&entry);
        dwarf_decl_line(&entry, &object.line);
        dwarf_decl_column(&entry, &object.column);
        object.address = *address;
        read_type(&entry, object);
        objects_.emplace(*address, std::move(object));
    }

    // "outer::inner::" for what is declared in there. An unnamed namespace is none.
    std::string qualifier_of(Dwarf_Die const& entry) {
        std::string qualifier;
        for (Dwarf_Die& scope : scope_finder_.scopes_around(origin_of(entry))) {
            switch (dwarf_tag(&scope)) {
                case DW_TAG_namespace:
                case DW_TAG_class_type:
                case DW_TAG_structure_type:
                case DW_TAG_union_type:
                    if (char const* name = dwarf_diename(&scope)) {
                        qualifier += std::string(name) + "::";
                    }
                    break;
                default:
                    break;
            }
        }
        return qualifier;
    }

    ProgramFile const& program_;
    ScopeFinder scope_finder_;
    DebugInfo info_;
    std::map<uint64_t, Object> objects_;
};

}  // namespace

std::optional<uint64_t> address_of(Dwarf_Die* variable) {
    Dwarf_Attribute location;
    Dwarf_Op* operations = nullptr;
    std::size_t count = 0;
    if (!dwarf_attr_integrate(variable, DW_AT_location, &location) ||
        dwarf_getlocation(&location, &operations, &count) != 0) {
        return std::nullopt;
    }
    std::optional<uint64_t> address;
    bool is_value = false;
    bool is_read = false;
    for (std::size_t i = 0; i < count; i++) {
        Dwarf_Op const& operation = operations[i];
        if (operation.atom == DW_OP_form_tls_address || operation.atom == DW_OP_GNU_push_tls_address) {
            return std::nullopt;
        }
        is_value = is_value || operation.atom == DW_OP_stack_value;
        is_read = is_read || operation.atom == DW_OP_deref || operation.atom == DW_OP_deref_size;
        if (address) {
            continue;  // a variable in pieces is where its first piece is
        }
        if (operation.atom == DW_OP_addr) {
            address = operation.number;
        } else if (operation.atom == DW_OP_addrx || operation.atom == DW_OP_GNU_addr_index) {
            Dwarf_Attribute entry;
            Dwarf_Addr found = 0;
            if (dwarf_getlocation_attr(&location, &operation, &entry) == 0 && dwarf_formaddr(&entry, &found) == 0) {
                address = found;
            }
        }
    }
    // An automatic variable may be the address of another one; compilers keep variables with two values as a flag.
    return is_value && !is_read ? std::nullopt : address;
}

std::string path_in(Dwarf_Die* unit, char const* file) {
    Dwarf_Attribute folder;
    std::filesystem::path const compiled_in =
        dwarf_attr(unit, DW_AT_comp_dir, &folder) ? text_of(dwarf_formstring(&folder)) : "";
    return (compiled_in / text_of(file)).lexically_normal().string();
}

std::string file_of(Dwarf_Die* entry) {
    Dwarf_Die unit;
    char const* const file = dwarf_decl_file(entry);
    if (!dwarf_diecu(entry, &unit, nullptr, nullptr)) {
        return text_of(file);
    }
    return path_in(&unit, file ? file : dwarf_diename(&unit));
}

DebugInfo read_debug_info(ProgramFile const& program) {
    return Reader(program).read();
}

}  // namespace shared_state
