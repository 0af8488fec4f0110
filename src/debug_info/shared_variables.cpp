#include "debug_info/shared_variables.hpp"

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "debug_info/configured.hpp"

namespace shared_state {

namespace {

// Shared unintentionally: writable, or set by the first robot that ran the line. (What is outside of functions is set
// before main().)
bool is_suspect(Object const& object, ProgramFile const& program) {
    auto const section = program.section_at(object.address);
    if (!section.writable || section.name.starts_with("pogo_shared")) {
        return false;
    }
    return !object.constant || (object.function_scope != 0 && program.has_guard(program.symbol_at(object.address)));
}

}  // namespace

bool is_in_folders(std::string const& file, std::vector<std::string> const& folders) {
    std::string const place = std::filesystem::weakly_canonical(file).string();
    return std::any_of(folders.begin(), folders.end(),
                       [&](std::string const& folder) { return place.starts_with(folder + "/"); });
}

std::vector<std::string> system_folders() {
    return {"/usr/include", "/usr/lib", "/usr/lib64", "/usr/local/include", "/usr/local/lib"};
}

std::vector<Object> shared_variables(DebugInfo const& info, ProgramFile const& program,
                                     std::vector<std::string> const& ignored_folders) {
    auto const configured = configured_objects(info);
    std::vector<Object> found;
    for (auto const& object : info.objects) {
        if (is_suspect(object, program) && !configured.contains(object.address) &&
            !is_in_folders(object.file, ignored_folders)) {
            found.push_back(object);
        }
    }
    auto const key = [](Object const& object) {
        return std::tie(object.file, object.line, object.column, object.name);
    };
    std::sort(found.begin(), found.end(), [&](Object const& a, Object const& b) { return key(a) < key(b); });
    auto const last =
        std::unique(found.begin(), found.end(), [&](Object const& a, Object const& b) { return key(a) == key(b); });
    found.erase(last, found.end());
    return found;
}

std::string shown_file(std::string const& file) {
    auto const relative = std::filesystem::path(file).lexically_proximate(std::filesystem::current_path());
    return relative.empty() || relative.string().starts_with("..") ? file : relative.string();
}

std::string shown_name(Object const& object) {
    return object.function.empty() ? "'" + object.qualifier + object.name + "'"
                                   : "'" + object.name + "' in " + object.function + "()";
}

}  // namespace shared_state
