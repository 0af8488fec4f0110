// Where files are that belong to a table and are written beside it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace pogosim {

/// The complete file of a table while a run writes it, if there is no other file of that name.
std::filesystem::path complete_file_beside(std::filesystem::path const& table);

/// The metadata of a table that cannot hold them.
std::filesystem::path metadata_path_of(std::filesystem::path const& table);

/// The same, if the name of the table says that it is such a one: a CSV file.
std::optional<std::filesystem::path> metadata_beside(std::string const& table);

}  // namespace pogosim
