// Writers of complete tables, one for each format.
#pragma once

#include <arrow/io/interfaces.h>
#include <arrow/ipc/writer.h>
#include <arrow/memory_pool.h>
#include <arrow/result.h>
#include <arrow/type.h>

#include <memory>
#include <string>

#include "base/table_format.hpp"

namespace pogosim {

/// A writer of tables with this schema. The bytes depend on the rows, and on how they are divided into batches, alone.
/// The file holds the metadata of the schema, except CSV, in which binary columns are hexadecimal numbers.
/// `memory`: for Feather; it outlives the writer.
arrow::Result<std::shared_ptr<arrow::ipc::RecordBatchWriter>> make_table_writer(
    TableFormat format, std::shared_ptr<arrow::io::OutputStream> const& stream,
    std::shared_ptr<arrow::Schema> const& schema, arrow::MemoryPool* memory);

/// Fails, with the reason, if this installation cannot write the format.
arrow::Status check_can_write(TableFormat format);

}  // namespace pogosim
