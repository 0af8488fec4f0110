// The data file during the run: complete record batches one after the other, and no footer. Whenever the run is
// killed, all batches can be read except one that is being written.
//
//     "ARROW1\0\0" │ schema │ batch │ batch │ ...        the same bytes as a Feather file has before its footer
//
// The schema's metadata say that the file is not complete.
#pragma once

#include <arrow/ipc/writer.h>
#include <arrow/record_batch.h>
#include <arrow/result.h>

#include <memory>
#include <string_view>

#include "tables/descriptor_stream.hpp"
#include "tables/table_memory.hpp"

namespace pogosim {

/// The first bytes of an Arrow file.
inline constexpr std::string_view kFileMagic("ARROW1\0\0", 8);

/// Metadata of unfinished files.
inline constexpr auto kIncompleteKey = "incomplete";

class UnfinishedFile {
public:
    /// Empties the open file and writes its head. `schema` is that of the complete file; `memory` outlives this.
    static arrow::Result<std::unique_ptr<UnfinishedFile>> start(int descriptor,
                                                                std::shared_ptr<arrow::Schema> const& schema,
                                                                arrow::MemoryPool* memory = table_memory());

    /// Appends rows. On failure, the file is unchanged.
    arrow::Status append(arrow::RecordBatch const& batch);

    /// Waits until everything is on disk, so that it survives a power failure.
    void sync() const;

    /// True if the size of the file is not what was written.
    bool was_changed_by_others() const;

private:
    explicit UnfinishedFile(int descriptor)
        : descriptor_(descriptor), stream_(std::make_shared<DescriptorStream>(descriptor)) {}

    int descriptor_;
    std::shared_ptr<DescriptorStream> stream_;
    std::shared_ptr<arrow::ipc::RecordBatchWriter> writer_;
    int64_t size_bytes_ = 0;  // up to the last complete batch
    bool torn_ = false;       // a partial batch may follow
};

}  // namespace pogosim
