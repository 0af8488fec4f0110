#include "tables/table_writer.hpp"

#include <arrow/api.h>
#include <arrow/csv/writer.h>
#include <arrow/util/compression.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdint>
#include <string_view>
#include <utility>

#include "base/library_folder.hpp"
#include "tables/parquet_module.hpp"
#include "tables/table_memory.hpp"

namespace pogosim {

using arrow::Result;
using arrow::Status;

namespace {

using Writer = std::shared_ptr<arrow::ipc::RecordBatchWriter>;

Result<Writer> make_feather_writer(std::shared_ptr<arrow::io::OutputStream> const& stream,
                                   std::shared_ptr<arrow::Schema> const& schema, arrow::MemoryPool* memory) {
    auto options = arrow::ipc::IpcWriteOptions::Defaults();
    ARROW_ASSIGN_OR_RAISE(options.codec, arrow::util::Codec::Create(arrow::Compression::ZSTD));
    options.memory_pool = memory;
    options.use_threads = false;  // the process stays single-threaded
    return arrow::ipc::MakeFileWriter(stream, schema, options);
}

/// The bytes of each cell as hexadecimal numbers.
Result<std::shared_ptr<arrow::Array>> in_hexadecimal(arrow::Array const& column) {
    auto const& cells = static_cast<arrow::BinaryArray const&>(column);
    arrow::StringBuilder texts(table_memory());
    for (std::int64_t row = 0; row < cells.length(); ++row) {
        if (cells.IsNull(row)) {
            ARROW_RETURN_NOT_OK(texts.AppendNull());
            continue;
        }
        std::string text;
        for (char const byte : cells.GetView(row)) {
            text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
        }
        ARROW_RETURN_NOT_OK(texts.Append(text));
    }
    return texts.Finish();
}

bool holds_bytes(arrow::DataType const& type) {
    return type.id() == arrow::Type::BINARY;
}

/// The schema of the text: binary columns become text.
std::shared_ptr<arrow::Schema> as_text(arrow::Schema const& schema) {
    arrow::FieldVector fields = schema.fields();
    for (auto& field : fields) {
        field = holds_bytes(*field->type()) ? field->WithType(arrow::utf8()) : field;
    }
    return arrow::schema(fields);
}

/// Writes CSV. Numbers have the fewest digits that give the same value when read back; null is an empty cell, an empty
/// text "".
class CsvWriter final : public arrow::ipc::RecordBatchWriter {
public:
    static Result<Writer> make(std::shared_ptr<arrow::io::OutputStream> const& stream, arrow::Schema const& schema) {
        auto options = arrow::csv::WriteOptions::Defaults();
        options.io_context = arrow::io::IOContext(table_memory());
        auto text_schema = as_text(schema);
        ARROW_ASSIGN_OR_RAISE(auto text, arrow::csv::MakeCSVWriter(stream, text_schema, options));
        return Writer(new CsvWriter(std::move(text), std::move(text_schema)));
    }

    Status WriteRecordBatch(arrow::RecordBatch const& batch) override {
        arrow::ArrayVector columns = batch.columns();
        for (auto& column : columns) {
            if (holds_bytes(*column->type())) {
                ARROW_ASSIGN_OR_RAISE(column, in_hexadecimal(*column));
            }
        }
        return text_->WriteRecordBatch(*arrow::RecordBatch::Make(schema_, batch.num_rows(), std::move(columns)));
    }
    Status Close() override { return text_->Close(); }
    arrow::ipc::WriteStats stats() const override { return text_->stats(); }

private:
    CsvWriter(Writer text, std::shared_ptr<arrow::Schema> schema)
        : text_(std::move(text)), schema_(std::move(schema)) {}

    Writer text_;
    std::shared_ptr<arrow::Schema> schema_;
};

/// The function of the module, which stays loaded.
Result<MakeParquetWriter> load_parquet() {
    std::string const path = (library_folder() / kParquetModuleFile).string();
    void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) {
        return Status::NotImplemented("this installation writes no Parquet files: ", dlerror());
    }
    auto const make = reinterpret_cast<MakeParquetWriter>(dlsym(module, kMakeParquetWriterName));
    if (make == nullptr) {
        return Status::NotImplemented("this installation writes no Parquet files: ", path, " is no module of Pogosim");
    }
    return make;
}

}  // namespace

Result<Writer> make_table_writer(TableFormat format, std::shared_ptr<arrow::io::OutputStream> const& stream,
                                 std::shared_ptr<arrow::Schema> const& schema, arrow::MemoryPool* memory) {
    switch (format) {
        case TableFormat::feather:
            return make_feather_writer(stream, schema, memory);
        case TableFormat::csv:
            return CsvWriter::make(stream, *schema);
        case TableFormat::parquet:
            break;
    }
    ARROW_ASSIGN_OR_RAISE(auto const make, load_parquet());
    Result<Writer> writer(Status::UnknownError("no writer"));
    make(stream, schema, writer);
    return writer;
}

Status check_can_write(TableFormat format) {
    return format == TableFormat::parquet ? load_parquet().status() : Status::OK();
}

}  // namespace pogosim
