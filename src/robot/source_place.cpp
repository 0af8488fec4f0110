#include "robot/source_place.hpp"

#include <cxxabi.h>
#include <fmt/format.h>

#ifdef POGOSIM_HAS_LIBDW
#include <dwarf.h>
#include <elfutils/libdw.h>
#include <fcntl.h>
#include <unistd.h>
#endif

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/escaped.hpp"

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

class DebugInfo {
public:
    explicit DebugInfo(std::string const& file)
        : descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC)),
          dwarf_(descriptor_ >= 0 ? dwarf_begin(descriptor_, DWARF_C_READ) : nullptr) {}
    ~DebugInfo() {
        dwarf_end(dwarf_);
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
    }
    DebugInfo(DebugInfo const&) = delete;
    DebugInfo& operator=(DebugInfo const&) = delete;

    /// The unit of compilation with this address. Not all compilers make a table of them.
    std::optional<Dwarf_Die> unit_at(Dwarf_Addr address) const {
        Dwarf_CU* unit = nullptr;
        Dwarf_Die entry;
        while (dwarf_ != nullptr && dwarf_get_units(dwarf_, unit, &unit, nullptr, nullptr, &entry, nullptr) == 0) {
            if (dwarf_haspc(&entry, address) > 0) {
                return entry;
            }
        }
        return std::nullopt;
    }

private:
    int descriptor_;
    Dwarf* dwarf_;
};

/// The source file of a line, with the path that was given to the compiler.
std::string_view file_of(Dwarf_Line* line, Dwarf_Die* unit) {
    char const* const file = dwarf_linesrc(line, nullptr, nullptr);
    std::string_view path = file != nullptr ? file : "";
    Dwarf_Attribute attribute;
    char const* const folder = dwarf_formstring(dwarf_attr(unit, DW_AT_comp_dir, &attribute));
    if (folder != nullptr && path.starts_with(folder) &&
        path.substr(std::string_view(folder).size()).starts_with('/')) {
        path.remove_prefix(std::string_view(folder).size() + 1);
    }
    return path;
}

/// The innermost function, which may be inlined into another.
std::string function_in(Dwarf_Die* unit, Dwarf_Addr address) {
    Dwarf_Die* scopes = nullptr;
    int const count = dwarf_getscopes(unit, address, &scopes);
    std::unique_ptr<Dwarf_Die, FreeMemory> const owner(scopes);
    for (int i = 0; i < count; ++i) {
        int const tag = dwarf_tag(&scopes[i]);
        char const* const name = dwarf_diename(&scopes[i]);
        if ((tag == DW_TAG_subprogram || tag == DW_TAG_inlined_subroutine) && name != nullptr) {
            return name;
        }
    }
    return "";
}

std::string place_by_debug_information(std::string const& file, std::uintptr_t address) {
    DebugInfo const info(file);
    std::optional<Dwarf_Die> unit = info.unit_at(address);
    Dwarf_Line* const line = unit ? dwarf_getsrc_die(&*unit, address) : nullptr;
    int number = 0;
    if (line == nullptr || dwarf_lineno(line, &number) != 0 || number == 0) {
        return "";
    }
    std::string const function = function_in(&*unit, address);
    if (is_start_of_process(function)) {
        return "";
    }
    return fmt::format("at {}:{}{}", file_of(line, &*unit), number,
                       function.empty() ? "" : fmt::format(" in {}()", own_name(function)));
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
