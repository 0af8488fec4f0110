// The formats of the tables that a run writes: the name of the file says which.
#pragma once

#include <optional>
#include <string>

namespace pogosim {

enum class TableFormat {
    feather,  // Apache Arrow IPC
    parquet,  // Apache Parquet
    csv       // text; the metadata are in a file beside it
};

/// What the ending of a name says: .feather, .arrow, .ipc, .parquet or .csv, in any case; a name without an ending is
/// that of a Feather file. A dot before a digit begins no ending: results_0.5. None for all other endings.
std::optional<TableFormat> table_format(std::string const& path);

/// The endings, for messages.
inline constexpr auto kTableEndings = ".feather, .arrow or .ipc (Apache Arrow), .parquet or .csv";

}  // namespace pogosim
