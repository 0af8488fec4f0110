#include "record/paths_beside.hpp"

#include "base/locked_file.hpp"
#include "base/scratch_file.hpp"
#include "base/table_format.hpp"

namespace pogosim {

std::filesystem::path complete_file_beside(std::filesystem::path const& table) {
    return real_path(table).native() + kUnfinishedSuffix;
}

std::filesystem::path metadata_path_of(std::filesystem::path const& table) {
    return real_path(table).native() + ".yaml";
}

std::optional<std::filesystem::path> metadata_beside(std::string const& table) {
    return table_format(table) == TableFormat::csv ? std::optional(metadata_path_of(table)) : std::nullopt;
}

}  // namespace pogosim
