#include "record/imported_poses.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/error.hpp"
#include "base/memory.hpp"
#include "record/tables_module.hpp"

namespace pogosim {

namespace {

TablesModule const& module_for(std::filesystem::path const& path) {
    try {
        return tables_module();
    } catch (OutOfMemory const&) {
        throw;
    } catch (std::runtime_error const& error) {
        throw ConfigError(
            fmt::format("formation_filename: cannot read poses from '{}': {}", path.string(), error.what()));
    }
}

}  // namespace

ImportedPoses read_imported_feather(std::filesystem::path const& path) {
    TablesModule const& module = module_for(path);
    return call_tables([&](TablesCall& call) { return module.read_imported_feather(path, call); });
}

}  // namespace pogosim
