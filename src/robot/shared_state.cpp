#include "robot/shared_state.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace pogosim {

using namespace std::string_view_literals;

namespace {

// Functions of the C and C++ libraries whose results do not depend on the caller or the order of calls, and that are
// safe on several threads. Not among them: strtok(), which remembers a text; fopen() and fprintf(), whose output would
// come in another order.
constexpr std::array kHarmless{"_DefaultRuneLocale"sv,
                               "_ITM_deregisterTMCloneTable"sv,
                               "_ITM_registerTMCloneTable"sv,
                               "_Unwind_Resume"sv,
                               "_ZSt9terminatev"sv,
                               "___chkstk_darwin"sv,
                               "__assert_fail"sv,
                               "__assert_rtn"sv,
                               "__bzero"sv,
                               "__ctype_b_loc"sv,
                               "__ctype_tolower_loc"sv,
                               "__ctype_toupper_loc"sv,
                               "__gmon_start__"sv,
                               "__gxx_personality_v0"sv,
                               "__isoc99_sscanf"sv,
                               "__libc_start_main"sv,
                               "__maskrune"sv,
                               "__stack_chk_fail"sv,
                               "__stack_chk_guard"sv,
                               "__tolower"sv,
                               "__toupper"sv,
                               "abort"sv,
                               "abs"sv,
                               "aligned_alloc"sv,
                               "atof"sv,
                               "atoi"sv,
                               "atol"sv,
                               "bcmp"sv,
                               "bsearch"sv,
                               "bzero"sv,
                               "calloc"sv,
                               "div"sv,
                               "free"sv,
                               "isalnum"sv,
                               "isalpha"sv,
                               "isdigit"sv,
                               "isspace"sv,
                               "labs"sv,
                               "ldiv"sv,
                               "malloc"sv,
                               "memchr"sv,
                               "memcmp"sv,
                               "memcpy"sv,
                               "memmove"sv,
                               "memset"sv,
                               "memset_pattern16"sv,
                               "memset_pattern4"sv,
                               "memset_pattern8"sv,
                               "pogosim_is_for_sdk"sv,
                               "qsort"sv,
                               "realloc"sv,
                               "snprintf"sv,
                               "sprintf"sv,
                               "sscanf"sv,
                               "stpcpy"sv,
                               "strcat"sv,
                               "strchr"sv,
                               "strcmp"sv,
                               "strcpy"sv,
                               "strlen"sv,
                               "strncat"sv,
                               "strncmp"sv,
                               "strncpy"sv,
                               "strnlen"sv,
                               "strrchr"sv,
                               "strstr"sv,
                               "strtod"sv,
                               "strtof"sv,
                               "strtol"sv,
                               "strtoul"sv,
                               "tolower"sv,
                               "toupper"sv,
                               "vsnprintf"sv,
                               "vsprintf"sv};
static_assert(std::ranges::is_sorted(kHarmless));

// Groups of functions: allocation, exceptions, containers and texts in C++.
constexpr std::array kHarmlessBeginnings{"__cxa_"sv,
                                         "_ZTI"sv,
                                         "_ZTS"sv,
                                         "_ZTV"sv,
                                         "_Znw"sv,
                                         "_Zna"sv,
                                         "_Zdl"sv,
                                         "_Zda"sv,
                                         "_ZNSt7__cxx1112basic_string"sv,
                                         "_ZNKSt7__cxx1112basic_string"sv,
                                         "_ZNSt8__detail15_List_node_base"sv,
                                         "_ZNKSt8__detail20_Prime_rehash_policy"sv,
                                         "_ZSt18_Rb_tree"sv,
                                         "_ZSt28_Rb_tree"sv,
                                         "_ZSt29_Rb_tree"sv,
                                         "_ZNKSt9exception"sv,
                                         "_ZNSt9exception"sv,
                                         "_ZNSt11logic_error"sv,
                                         "_ZNSt12out_of_range"sv,
                                         "_ZNSt13runtime_error"sv,
                                         "_ZNSt16invalid_argument"sv};

// Variables of every program that do not change after its start.
constexpr std::array kOwnVariables{"REGISTER_USERDATA_once"sv, "UserdataConstruct"sv, "UserdataSize"sv,
                                   "_ZStL8__ioinit"sv, "__dso_handle"sv};

/// The start of the object that a place in memory belongs to, and its file.
struct NamedObject {
    void* begin = nullptr;
    std::string_view file{};
};

NamedObject object_of(void const* place) {
    Dl_info info;
    return place != nullptr && dladdr(place, &info) != 0 ? NamedObject{info.dli_fbase, info.dli_fname} : NamedObject{};
}

NamedObject const& simulator() {
    static NamedObject const found = object_of(reinterpret_cast<void const*>(&pogosim_rand));
    return found;
}

constexpr auto kInOneFile = "the program and the simulator are in one file";
constexpr auto kNoSymbols = "the program has no symbol table, which tells what it uses: link it without -s";

bool is_in_file_of_simulator(ProgramImage const& image) {
    return object_of(reinterpret_cast<void const*>(image.main)).begin == simulator().begin;
}

/// The name of a function of the C library without what says that it checks sizes: "__memcpy_chk" is "memcpy".
std::string_view without_check(std::string_view name) {
    bool const is_checked_variant = name.starts_with("__") && name.ends_with("_chk");
    return is_checked_variant ? name.substr(2, name.size() - 6) : name;
}

bool is_harmless_name(std::string_view name) {
    name = without_check(name);
    auto const begins = [name](std::string_view beginning) { return name.starts_with(beginning); };
    bool const throws = name.starts_with("_ZSt") && name.find("__throw_") != std::string_view::npos;
    return throws || std::ranges::binary_search(kHarmless, name) || std::ranges::any_of(kHarmlessBeginnings, begins);
}

constexpr auto kNoStatic =
    "the symbols of the program's static variables were stripped, so what robots share is not known: link it without "
    "-Wl,-x";
constexpr auto kNamelessOfThreads = "each thread has its own variables (thread_local), whose symbols were stripped";

/// Whether there are variables of threads that the symbol table does not have: the linker leaves out local symbols with
/// -Wl,-x.
bool has_nameless_variables_of_threads(ProgramSymbols const& symbols) {
    std::size_t named = 0;
    for (ProgramSymbols::Variable const& variable : symbols.variables) {
        named += variable.is_of_thread ? variable.bytes : 0;
    }
    return symbols.bytes_of_threads > named;
}

/// As malloc() and its relatives do, and operator new.
bool allocates(std::string_view name) {
    return name == "malloc" || name == "calloc" || name == "realloc" || name == "aligned_alloc" ||
           name.starts_with("_Znw") || name.starts_with("_Zna");
}

/// What tells that sscanf() may allocate texts: free(), which gives them back, or a format; empty: nothing.
std::string how_texts_are_allocated(ProgramSymbols const& symbols) {
    bool const gives_back = std::ranges::find(symbols.imports, "free") != symbols.imports.end();
    return gives_back ? "free" : symbols.allocating_format;
}

/// Whether a function leaves nothing behind outside of the program's own memory. Texts, containers and exceptions of
/// C++ do: they are on the heap. What gives memory back does not: there is none without what allocates it.
bool leaves_no_state(std::string_view name) {
    constexpr std::array of_runtime{"__cxa_atexit"sv,        "__cxa_begin_catch"sv,  "__cxa_deleted_virtual"sv,
                                    "__cxa_finalize"sv,      "__cxa_guard_abort"sv,  "__cxa_guard_acquire"sv,
                                    "__cxa_guard_release"sv, "__cxa_pure_virtual"sv, "__tls_get_addr"sv};
    auto const begins = [name](std::string_view beginning) { return name.starts_with(beginning); };
    constexpr std::array groups{"_ZTI"sv, "_ZTS"sv, "_ZTV"sv, "_Zdl"sv, "_Zda"sv};
    return std::ranges::any_of(groups, begins) || std::ranges::find(of_runtime, name) != of_runtime.end() ||
           std::ranges::binary_search(kHarmless, without_check(name));
}

/// The standard streams of C++: a program that includes <iostream> prepares them before its main(). What it prints
/// there is another matter.
bool is_of_streams(std::string_view name) {
    constexpr std::array beginnings{
        "_ZNSt8ios_base4Init"sv, "_ZSt4cout"sv, "_ZSt4cerr"sv, "_ZSt4clog"sv,  "_ZNSo"sv,
        "_ZNKSt5ctypeIcE"sv,     "_ZStls"sv,    "_ZSt4endl"sv, "_ZSt5flush"sv, "_ZSt16__ostream_insert"sv};
    return std::ranges::any_of(beginnings, [name](std::string_view beginning) { return name.starts_with(beginning); });
}

/// The simulator's own functions know of threads; the mathematical ones have no state, but for those that set
/// how numbers are rounded (fesetround() and so on), and the sign that lgamma() leaves.
bool is_of_simulator_or_mathematical(std::string const& name) {
    if (name.starts_with("fe") || name == "signgam") {
        return false;
    }
    static void* const library = dlopen(std::string(simulator().file).c_str(), RTLD_NOW | RTLD_NOLOAD);
    NamedObject const object = object_of(library != nullptr ? dlsym(library, name.c_str()) : nullptr);
    return object.begin != nullptr &&
           (object.begin == simulator().begin || object.file.find("/libm.so") != std::string_view::npos ||
            object.file.find("/libm-") != std::string_view::npos ||
            object.file.find("/libsystem_m.") != std::string_view::npos);
}

bool is_own(std::string_view name) {
    // completed.0: of the C compiler, set when the program ends. DW.ref: where C++ finds its own functions. _ZGV:
    // guards of static variables, which are in the table, too.
    return std::ranges::find(kOwnVariables, name) != kOwnVariables.end() || name.starts_with("completed.") ||
           name.starts_with("DW.ref.") || name.starts_with("pogo_user_data_") || name.starts_with("_ZGV");
}

std::byte* address_in(ProgramImage const& image, ProgramSymbols::Variable const& variable) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
    return reinterpret_cast<std::byte*>(image.load_address + variable.address);
}

/// Whether each byte of the variable is set from the configuration.
bool is_configured(std::byte const* begin, std::size_t bytes, std::span<BoundVariable const> bound) {
    std::vector<bool> is_bound(bytes, false);
    for (BoundVariable const& one : bound) {
        auto const* const first = static_cast<std::byte const*>(one.variable);
        if (first >= begin && first < begin + bytes) {
            std::size_t const offset = static_cast<std::size_t>(first - begin);
            std::fill_n(is_bound.begin() + static_cast<std::ptrdiff_t>(offset), std::min(one.bytes, bytes - offset),
                        true);
        }
    }
    return std::ranges::find(is_bound, false) == is_bound.end();
}

}  // namespace

std::string why_one_after_the_other(ProgramImage const& image, std::span<BoundVariable const> bound) {
    if (is_in_file_of_simulator(image)) {
        return kInOneFile;
    }
    ProgramSymbols const symbols = image.symbols();
    if (!symbols.are_known) {
        return kNoSymbols;
    }
    for (ProgramSymbols::Variable const& variable : symbols.variables) {
        if (!is_own(variable.name) &&
            (variable.is_of_thread || !is_configured(address_in(image, variable), variable.bytes, bound))) {
            if (variable.name == "mydata") {
                return "the program declares 'mydata' as one for all threads (by hand, or with REGISTER_USERDATA "
                       "alone): write DECLARE_USERDATA in its place, or before it";
            }
            bool const is_constant_of_first = symbols.has_guard(variable.name);
            return fmt::format("all robots share the variable '{}' ({})", name_by_symbol(variable.name),
                               is_constant_of_first
                                   ? "the first robot that gets there sets it: put it into USERDATA, or make it "
                                     "constexpr"
                                   : "put it into USERDATA, or declare it const");
        }
    }
    if (has_nameless_variables_of_threads(symbols)) {
        return kNamelessOfThreads;
    }
    if (!symbols.has_static) {
        return kNoStatic;
    }
    for (std::string const& name : symbols.imports) {
        if (!is_harmless_name(name) && !is_of_simulator_or_mathematical(name)) {
            return fmt::format("the program uses '{}', which may have a state that all robots share", name);
        }
    }
    return "";
}

std::string why_state_is_not_copied(ProgramImage const& image) {
    if (image.main == nullptr) {
        return "";  // there is none
    }
    if (is_in_file_of_simulator(image)) {
        return kInOneFile;
    }
    ProgramSymbols const symbols = image.symbols();
    if (!symbols.are_known) {
        return kNoSymbols;
    }
    auto const is_of_thread = [](ProgramSymbols::Variable const& variable) {
        return variable.is_of_thread && !is_own(variable.name) && variable.name != "mydata";
    };
    if (auto const found = std::ranges::find_if(symbols.variables, is_of_thread); found != symbols.variables.end()) {
        return fmt::format("each thread has its own '{}' (thread_local), which is not copied",
                           name_by_symbol(found->name));
    }
    if (has_nameless_variables_of_threads(symbols)) {
        return fmt::format("{}, which are not copied", kNamelessOfThreads);
    }
    for (std::string const& name : symbols.imports) {
        if (allocates(name)) {
            return fmt::format("the program allocates memory ('{}'), which is not copied: use arrays of a fixed size",
                               name_by_symbol(name));
        }
        if (std::string const how = how_texts_are_allocated(symbols); name.ends_with("sscanf") && !how.empty()) {
            return fmt::format("the program may allocate memory ('{}' with '{}'), which is not copied", name, how);
        }
        if (!leaves_no_state(name) && !is_of_simulator_or_mathematical(name)) {
            return fmt::format("the program uses '{}', which may have a state of its own", name_by_symbol(name));
        }
    }
    return "";
}

std::string why_run_is_not_repeated(ProgramImage const& image) {
    if (image.constructors) {
        return "the program has functions that run before its main(), such as constructors of static objects";
    }
    if (loaded_object_at(reinterpret_cast<void const*>(image.main)).finalizers.size() > kFunctionsOfCompiler) {
        return "the program has functions that run at its end";
    }
    std::vector<std::string> const imports = image.symbols().imports;
    if (std::ranges::find(imports, "__cxa_guard_acquire") != imports.end()) {
        return "the program has static objects in functions";
    }
    return why_state_is_not_copied(image);
}

std::string why_process_is_not_copied(ProgramImage const& image) {
    if (!image.constructors) {
        return "";
    }
    if (is_in_file_of_simulator(image)) {
        return kInOneFile;
    }
    ProgramSymbols const symbols = image.symbols();
    if (!symbols.are_known) {
        return kNoSymbols;
    }
    for (std::string const& name : symbols.imports) {
        if (!is_harmless_name(name) && !is_of_streams(name) && !is_of_simulator_or_mathematical(name)) {
            return fmt::format("what runs before its main() may use '{}', which is not the same in each process",
                               name_by_symbol(name));
        }
    }
    return "";
}

std::string function_that_calls_back(ProgramImage const& image) {
    for (std::string const& name : image.symbols().imports) {
        if (name == "qsort" || name == "bsearch") {
            return name;
        }
    }
    return "";
}

std::vector<ProgramSymbols::Variable> variables_of_all_robots(ProgramImage const& image,
                                                              std::span<BoundVariable const> bound) {
    if (is_in_file_of_simulator(image)) {
        return {};
    }
    ProgramSymbols symbols = image.symbols();
    auto const is_robots = [&](ProgramSymbols::Variable const& variable) {
        return std::ranges::any_of(symbols.memory, [&](ProgramSymbols::Piece const& piece) {
            return variable.address >= piece.begin && variable.address < piece.end;
        });
    };
    auto const has_configured_part = [&](ProgramSymbols::Variable const& variable) {
        std::byte const* const begin = address_in(image, variable);
        return std::ranges::any_of(bound, [&](BoundVariable const& one) {
            auto const* const place = static_cast<std::byte const*>(one.variable);
            return place >= begin && place < begin + variable.bytes;
        });
    };
    // Names that begin with two underscores are the compiler's.
    auto const is_of_compiler = [](ProgramSymbols::Variable const& variable) {
        return variable.name.starts_with("__") || is_own(variable.name);
    };
    std::erase_if(symbols.variables, [&](ProgramSymbols::Variable const& variable) {
        return variable.is_of_thread || is_of_compiler(variable) || !is_robots(variable) ||
               has_configured_part(variable);
    });
    return symbols.variables;
}

std::string why_memory_is_shared(ProgramImage const& image) {
    if (is_in_file_of_simulator(image)) {
        return kInOneFile;
    }
    auto const is_in_program = [&](std::span<std::byte> piece) {
        return is_in_any(image.variables, piece.data()) && is_in_any(image.variables, piece.data() + piece.size() - 1);
    };
    if (image.symbols().memory.empty() || !std::ranges::all_of(image.memory_of_robots(), is_in_program)) {
        return "its file does not say where they are: link it without -Wl,--strip-section-headers and the like";
    }
    return "";
}

ConfiguredVariables::ConfiguredVariables(ProgramImage const& image, std::span<BoundVariable const> bound) {
    for (BoundVariable const& one : bound) {
        if (is_in_any(image.variables, one.variable)) {
            variables_.push_back({.name = one.name,
                                  .now = std::span(static_cast<std::byte const*>(one.variable), one.bytes),
                                  .remembered = {}});
        }
    }
}

void ConfiguredVariables::remember() {
    for (Variable& variable : variables_) {
        variable.remembered.assign(variable.now.begin(), variable.now.end());
    }
}

std::string ConfiguredVariables::changed() const {
    auto const is_changed = [](Variable const& one) { return !std::ranges::equal(one.now, one.remembered); };
    auto const found = std::ranges::find_if(variables_, is_changed);
    return found != variables_.end() ? found->name : "";
}

}  // namespace pogosim
