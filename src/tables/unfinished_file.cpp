#include "tables/unfinished_file.hpp"

#include <arrow/type.h>
#include <arrow/util/compression.h>
#include <arrow/util/key_value_metadata.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pogosim {

namespace {

constexpr auto kIncomplete =
    "The run is still going on, or it was killed. pogosim.utils.load_dataframe reads the rows; pogosim-recover turns "
    "this file into a complete Feather file.";

std::shared_ptr<arrow::Schema> marked(arrow::Schema const& schema) {
    auto metadata = std::make_shared<arrow::KeyValueMetadata>();
    if (auto const given = schema.metadata()) {
        metadata = given->Copy();
    }
    metadata->Append(kIncompleteKey, kIncomplete);
    return schema.WithMetadata(metadata);
}

}  // namespace

arrow::Result<std::unique_ptr<UnfinishedFile>> UnfinishedFile::start(int descriptor,
                                                                     std::shared_ptr<arrow::Schema> const& schema,
                                                                     arrow::MemoryPool* memory) {
    std::unique_ptr<UnfinishedFile> file(new UnfinishedFile(descriptor));
    auto options = arrow::ipc::IpcWriteOptions::Defaults();
    ARROW_ASSIGN_OR_RAISE(options.codec, arrow::util::Codec::Create(arrow::Compression::LZ4_FRAME));
    options.memory_pool = memory;
    options.use_threads = false;
    ARROW_RETURN_NOT_OK(file->stream_->Write(kFileMagic.data(), kFileMagic.size()));
    ARROW_ASSIGN_OR_RAISE(file->writer_, arrow::ipc::MakeStreamWriter(file->stream_, marked(*schema), options));
    // The schema is written with the first batch only, but a file without rows must also be readable.
    ARROW_ASSIGN_OR_RAISE(auto const nothing, arrow::RecordBatch::MakeEmpty(schema, memory));
    ARROW_RETURN_NOT_OK(file->writer_->WriteRecordBatch(*nothing));
    // The head is written before the old contents are cut off, so that the file never lacks it. A reader that comes
    // just then may find a part of the head, or rows of the older file behind it, which it takes for torn ones.
    ARROW_RETURN_NOT_OK(file->stream_->Flush());
    ARROW_ASSIGN_OR_RAISE(file->size_bytes_, file->stream_->Tell());
    file->stream_->go_back_to(file->size_bytes_);
    return file;
}

arrow::Status UnfinishedFile::append(arrow::RecordBatch const& batch) {
    // The next batch must not follow one that was truncated by a crash or a full disk.
    if (torn_) {
        stream_->go_back_to(size_bytes_);
    }
    torn_ = true;
    auto status = writer_->WriteRecordBatch(batch);
    if (status.ok()) {
        status = stream_->Flush();
    }
    if (!status.ok()) {
        stream_->go_back_to(size_bytes_);
        return status;
    }
    ARROW_ASSIGN_OR_RAISE(size_bytes_, stream_->Tell());
    torn_ = false;
    return arrow::Status::OK();
}

bool UnfinishedFile::was_changed_by_others() const {
    struct stat now = {};
    return !torn_ && fstat(descriptor_, &now) == 0 && now.st_size != size_bytes_;
}

void UnfinishedFile::sync() const {
#ifdef __APPLE__
    fsync(descriptor_);
#else
    fdatasync(descriptor_);
#endif
}

}  // namespace pogosim
