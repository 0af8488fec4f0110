// The entry point of libpogosim_parquet, a module that libpogosim loads only when a Parquet file is wanted, so that
// other runs do not load the Parquet library. Both are built together.
#pragma once

#include <arrow/io/interfaces.h>
#include <arrow/ipc/writer.h>
#include <arrow/result.h>
#include <arrow/type.h>

#include <memory>

#include "pogosim/version.h"

namespace pogosim {

/// Sets `writer` to one of tables with this schema.
using MakeParquetWriter = void (*)(std::shared_ptr<arrow::io::OutputStream> const& stream,
                                   std::shared_ptr<arrow::Schema> const& schema,
                                   arrow::Result<std::shared_ptr<arrow::ipc::RecordBatchWriter>>& writer);

inline constexpr char const* kMakeParquetWriterName = "pogosim_make_parquet_writer";

/// The file, beside that of libpogosim.
#ifdef __APPLE__
inline constexpr char const* kParquetModuleFile = "libpogosim_parquet-" POGOSIM_VERSION_STRING ".dylib";
#else
inline constexpr char const* kParquetModuleFile = "libpogosim_parquet-" POGOSIM_VERSION_STRING ".so";
#endif

}  // namespace pogosim
