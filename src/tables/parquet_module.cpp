#include "tables/parquet_module.hpp"

#include <arrow/memory_pool.h>
#include <arrow/record_batch.h>
#include <arrow/table.h>
#include <parquet/arrow/writer.h>
#include <parquet/properties.h>

#include <utility>

namespace pogosim {

namespace {

/// Gives Arrow's Parquet writer the interface of its writer of Arrow files.
class ParquetWriter final : public arrow::ipc::RecordBatchWriter {
public:
    explicit ParquetWriter(std::unique_ptr<parquet::arrow::FileWriter> file) : file_(std::move(file)) {}

    arrow::Status WriteRecordBatch(arrow::RecordBatch const& batch) override {
        ++stats_.num_record_batches;
        return file_->WriteRecordBatch(batch);
    }
    arrow::Status WriteTable(arrow::Table const& table, int64_t rows_per_group) override {
        return file_->WriteTable(table, rows_per_group);
    }
    arrow::Status Close() override { return file_->Close(); }
    arrow::ipc::WriteStats stats() const override { return stats_; }

private:
    std::unique_ptr<parquet::arrow::FileWriter> file_;
    arrow::ipc::WriteStats stats_;
};

arrow::Result<std::shared_ptr<arrow::ipc::RecordBatchWriter>> make_writer(
    std::shared_ptr<arrow::io::OutputStream> const& stream, std::shared_ptr<arrow::Schema> const& schema) {
    auto const properties = parquet::WriterProperties::Builder().compression(parquet::Compression::ZSTD)->build();
    auto const arrow_properties = parquet::ArrowWriterProperties::Builder().store_schema()->build();
    ARROW_ASSIGN_OR_RAISE(auto file, parquet::arrow::FileWriter::Open(*schema, arrow::default_memory_pool(), stream,
                                                                      properties, arrow_properties));
    return std::make_shared<ParquetWriter>(std::move(file));
}

}  // namespace

}  // namespace pogosim

extern "C" __attribute__((visibility("default"))) void pogosim_make_parquet_writer(
    std::shared_ptr<arrow::io::OutputStream> const& stream, std::shared_ptr<arrow::Schema> const& schema,
    arrow::Result<std::shared_ptr<arrow::ipc::RecordBatchWriter>>& writer) {
    writer = pogosim::make_writer(stream, schema);
}
