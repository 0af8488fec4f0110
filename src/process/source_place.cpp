#include "process/backtrace.hpp"

#include <cxxabi.h>
#include <fmt/format.h>

#ifdef POGOSIM_HAS_LIBDW
#include <dwarf.h>
#include <elfutils/libdw.h>

#include "debug_info/entries.hpp"
#endif

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/escaped.hpp"
#include "process/program_image.hpp"

namespace pogosim {

namespace {

struct FreeMemory {
    void operator()(void* memory) const { std::free(memory); }
};

/// Functions above all user code in a stack. The headers rename the program's main().
bool is_start_of_process(std::string const& function) {
    return function == "_start" || function == "main";
}

std::string own_name(std::string const& function) {
    return function == "robot_main" ? "main" : function;
}

/// As in the source: "Swarm::step(int)", or "compute()" in C, whose symbols do not name parameters. Compilers name
/// parts and copies of a function "compute.cold" and "compute.isra.0".
std::string written_name(std::string const& symbol) {
    std::string const function = own_name(symbol.substr(0, symbol.find('.')));
    int status = 0;
    std::unique_ptr<char, FreeMemory> const name(abi::__cxa_demangle(function.c_str(), nullptr, nullptr, &status));
    return name != nullptr ? name.get() : function + "()";
}

#ifdef POGOSIM_HAS_LIBDW

/// The unit of compilation with this address. Not all compilers make a table of them.
std::optional<Dwarf_Die> unit_at(Dwarf* debug_info, Dwarf_Addr address) {
    std::optional<Dwarf_Die> found;
    shared_state::for_each_unit(debug_info, [&](Dwarf_Die& unit) {
        if (!found && dwarf_haspc(&unit, address) > 0) {
            found = unit;
        }
    });
    return found;
}

/// As it was given to the compiler.
std::string_view without_folder(char const* file, Dwarf_Die* unit) {
    std::string_view path = file != nullptr ? file : "";
    Dwarf_Attribute attribute;
    char const* const folder = dwarf_formstring(dwarf_attr(unit, DW_AT_comp_dir, &attribute));
    if (folder != nullptr && path.starts_with(folder) &&
        path.substr(std::string_view(folder).size()).starts_with('/')) {
        path.remove_prefix(std::string_view(folder).size() + 1);
    }
    return path;
}

struct SourceLine {
    char const* file = nullptr;
    int number = 0;  // 0: unknown
    std::string function;
};

SourceLine line_at(Dwarf_Die* unit, Dwarf_Addr address) {
    SourceLine found;
    if (Dwarf_Line* const line = dwarf_getsrc_die(unit, address); line != nullptr) {
        found.file = dwarf_linesrc(line, nullptr, nullptr);
        dwarf_lineno(line, &found.number);
    }
    return found;
}

/// Where an inlined function is called.
SourceLine call_of(Dwarf_Die* inlined, Dwarf_Die* unit) {
    Dwarf_Attribute attribute;
    Dwarf_Word file = 0;
    Dwarf_Word line = 0;
    Dwarf_Files* files = nullptr;
    std::size_t count = 0;
    bool const is_known = dwarf_formudata(dwarf_attr(inlined, DW_AT_call_file, &attribute), &file) == 0 &&
                          dwarf_formudata(dwarf_attr(inlined, DW_AT_call_line, &attribute), &line) == 0 &&
                          dwarf_getsrcfiles(unit, &files, &count) == 0 && file < count;
    return is_known ? SourceLine{dwarf_filesrc(files, file, nullptr, nullptr), static_cast<int>(line), ""}
                    : SourceLine{};
}

/// An inline function of our headers: POGO_INLINE.
bool is_artificial(Dwarf_Die* function) {
    Dwarf_Attribute attribute;
    bool is_set = false;
    return dwarf_formflag(dwarf_attr_integrate(function, DW_AT_artificial, &attribute), &is_set) == 0 && is_set;
}

/// The line in the innermost function of the program's own, which may be inlined into another.
SourceLine own_line_at(Dwarf_Die* unit, Dwarf_Addr address) {
    SourceLine found = line_at(unit, address);
    Dwarf_Die* innermost = nullptr;
    int const any = dwarf_getscopes(unit, address, &innermost);
    std::unique_ptr<Dwarf_Die, FreeMemory> const owner_of_innermost(innermost);
    // From there outwards through the callers, where dwarf_getscopes() leaves an inlined function for its definition.
    Dwarf_Die* scopes = nullptr;
    int const count = any > 0 ? dwarf_getscopes_die(innermost, &scopes) : 0;
    std::unique_ptr<Dwarf_Die, FreeMemory> const owner(scopes);
    for (int i = 0; i < count; ++i) {
        int const tag = dwarf_tag(&scopes[i]);
        char const* const name = dwarf_diename(&scopes[i]);
        if (tag == DW_TAG_inlined_subroutine && is_artificial(&scopes[i])) {
            found = call_of(&scopes[i], unit);
        } else if ((tag == DW_TAG_subprogram || tag == DW_TAG_inlined_subroutine) && name != nullptr) {
            found.function = name;
            return found;
        }
    }
    return found;
}

std::string place_by_debug_information(std::string const& file, std::uintptr_t address) {
    shared_state::DebugFile const info(file);
    std::optional<Dwarf_Die> unit = unit_at(info.debug_info(), address);
    SourceLine const line = unit ? own_line_at(&*unit, address) : SourceLine{};
    if (line.number == 0 || is_start_of_process(line.function)) {
        return "";
    }
    return fmt::format("at {}:{}{}", without_folder(line.file, &*unit), line.number,
                       line.function.empty() ? "" : fmt::format(" in {}()", own_name(line.function)));
}

#else

std::string place_by_debug_information(std::string const& /*file*/, std::uintptr_t /*address*/) {
    return "";
}

#endif

}  // namespace

std::string place_in_source(ProgramImage const& image, void const* place) {
    std::vector<char> const bytes = place != nullptr ? image.bytes_of_file() : std::vector<char>();
    if (bytes.empty()) {
        return "";
    }
    std::uintptr_t const address = reinterpret_cast<std::uintptr_t>(place) - image.load_address;
    std::string text = place_by_debug_information(image.file.string(), address);
    if (text.empty()) {
        std::string const function = function_at(bytes, address);
        text = function.empty() || is_start_of_process(function) ? "" : "in " + written_name(function);
    }
    return escaped(text);
}

}  // namespace pogosim
