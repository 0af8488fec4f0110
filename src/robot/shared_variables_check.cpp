#include "robot/shared_variables_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/escaped.hpp"
#include "base/log.hpp"
#include "process/process.hpp"
#include "robot/shared_state.hpp"

#ifdef POGOSIM_HAS_LIBDW
#include "debug_info/shared_variables.hpp"
#endif

namespace pogosim {

namespace {

constexpr std::size_t kMostNames = 3;

struct Found {
    std::vector<std::string> names{};  // "'steps' in user_step() (main.c:31)"
    bool is_certain = true;
};

/// Whether the program was not looked at before: in a host, which may make many runs of it. Runs of an executable are
/// each one of its own.
bool is_new(ProgramImage const& image) {
    if (process_is_ours()) {
        return true;
    }
    using Program = std::pair<std::filesystem::path, std::filesystem::file_time_type>;
    static std::mutex mutex;
    static std::set<Program> known;
    std::lock_guard const lock(mutex);
    return known.emplace(image.file, image.file_time).second;
}

/// What calls of init_from_configuration() have left in the program (POGO_NOTE_CONFIGURED): "gain", "&limits.low".
std::vector<std::string> configured_expressions(ProgramImage const& image) {
    return texts_of(image.bytes_of_file(), "pogosim_configured");
}

/// Whether an expression contains this word.
bool mentions(std::string_view expression, std::string_view word) {
    auto const is_part_of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (std::size_t at = expression.find(word); at != std::string_view::npos; at = expression.find(word, at + 1)) {
        std::size_t const end = at + word.size();
        if ((at == 0 || !is_part_of_word(expression[at - 1])) &&
            (end == expression.size() || !is_part_of_word(expression[end]))) {
            return true;
        }
    }
    return false;
}

/// Finds shared variables by symbols alone. These do not distinguish variables from C++ constants that are initialised
/// at run time, before main() or when the first robot gets there (then they have a guard). Parameters are recognised by
/// name, even if they have not been read yet.
Found found_by_symbols(ProgramImage const& image, std::vector<ProgramSymbols::Variable> const& suspects) {
    Found found{.is_certain = image.constructors == nullptr};
    ProgramSymbols const symbols = suspects.empty() ? ProgramSymbols() : image.symbols();
    std::vector<std::string> const configured =
        suspects.empty() ? std::vector<std::string>() : configured_expressions(image);
    for (ProgramSymbols::Variable const& variable : suspects) {
        std::string const name = name_by_symbol(variable.name);
        std::string_view const word = std::string_view(name).substr(std::min(name.rfind(':') + 1, name.size()));
        auto const is_mentioned = [word](std::string const& expression) { return mentions(expression, word); };
        if (std::ranges::none_of(configured, is_mentioned)) {
            found.is_certain = found.is_certain && !symbols.has_guard(variable.name);
            found.names.push_back(fmt::format("'{}'", name));
        }
    }
    return found;
}

#ifdef POGOSIM_HAS_LIBDW

Found found_in(ProgramImage const& image, std::vector<ProgramSymbols::Variable> suspects) {
    std::error_code error;
    if (image.loaded && std::filesystem::last_write_time(image.file, error) != image.file_time) {
        return found_by_symbols(image, suspects);  // the file was rebuilt after it was loaded
    }
    try {
        shared_state::ProgramFile const file(image.file.string());
        shared_state::DebugInfo const info = shared_state::read_debug_info(file);
        std::set<std::uint64_t> known;
        for (shared_state::Object const& object : info.objects) {
            known.insert(object.address);
        }
        std::set<std::uint64_t> suspected;
        for (ProgramSymbols::Variable const& variable : suspects) {
            suspected.insert(variable.address);
        }
        std::erase_if(suspects, [&](auto const& variable) { return known.contains(variable.address); });
        Found found = found_by_symbols(image, suspects);
        std::vector<std::string> with_lines;
        for (shared_state::Object const& object :
             shared_state::shared_variables(info, file, shared_state::system_folders())) {
            // A constant object has a constructor, so it is set when the first robot gets there, even to the same text
            // for all; a number is only if it is calculated then.
            bool const is_usual_constant = object.constant && object.structure;
            if (suspected.contains(object.address) && !is_usual_constant) {
                with_lines.push_back(fmt::format("{} ({}:{}{})", shared_state::shown_name(object),
                                                 shared_state::shown_file(object.file), object.line,
                                                 object.constant ? ", set once, by the first robot" : ""));
            }
        }
        found.is_certain = found.is_certain || found.names.empty();
        found.names.insert(found.names.begin(), with_lines.begin(), with_lines.end());
        return found;
    } catch (std::exception const&) {  // no debug information
        return found_by_symbols(image, suspects);
    }
}

#else

Found found_in(ProgramImage const& image, std::vector<ProgramSymbols::Variable> const& suspects) {
    return found_by_symbols(image, suspects);
}

#endif

}  // namespace

void warn_of_shared_variables(ProgramImage const& image, std::span<BoundVariable const> bound, std::size_t robots) {
    if (robots < 2) {
        return;
    }
    std::vector<ProgramSymbols::Variable> const suspects = variables_of_all_robots(image, bound);
    if (suspects.empty() || !is_new(image)) {
        return;
    }
    Found const found = found_in(image, suspects);
    if (found.names.empty()) {
        return;
    }
    std::size_t const count = found.names.size();
    std::size_t const shown = count > kMostNames + 1 ? kMostNames : count;
    std::string const text = fmt::format(
        "all robots share the variable{} {}{}, which real robots cannot: a clock or counter there that each robot "
        "advances runs {} times too fast. Put what each robot has into USERDATA, read parameters with "
        "init_from_configuration(), declare constants const and what the supervisor or all robots use POGO_SHARED, or "
        "set robot_memory: own",
        count == 1 ? "" : "s", fmt::join(std::span(found.names).first(shown), ", "),
        shown < count ? fmt::format(" and {} more", count - shown) : "", robots);
    log().log(found.is_certain ? spdlog::level::warn : spdlog::level::info, "{}", escaped(text));
}

}  // namespace pogosim
