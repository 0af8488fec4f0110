// The complete data file in progress: a file that is written next to the unfinished one and replaces it at the end, so
// that at any time one of the two contains all rows. It is a Feather file, converted to another format at the end if
// the user wants one.
#pragma once

#include <arrow/ipc/writer.h>
#include <arrow/memory_pool.h>
#include <arrow/record_batch.h>
#include <arrow/result.h>
#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "base/locked_file.hpp"
#include "base/scratch_file.hpp"
#include "base/table_format.hpp"
#include "tables/descriptor_stream.hpp"

namespace pogosim {

class CompleteFile {
public:
    /// Makes an empty file beside `unfinished`, else one without a name in the folder for temporary files. Removes a
    /// file that a killed run has left there, but no other file. `memory` outlives this.
    static arrow::Result<std::unique_ptr<CompleteFile>> start(LockedFile const& unfinished,
                                                              std::shared_ptr<arrow::Schema> const& schema,
                                                              arrow::MemoryPool* memory,
                                                              TableFormat format = TableFormat::feather);

    /// Removes the file, unless it has taken its place.
    ~CompleteFile();

    CompleteFile(CompleteFile const&) = delete;
    CompleteFile& operator=(CompleteFile const&) = delete;

    arrow::Status append(arrow::RecordBatch const& batch) { return writer_->WriteRecordBatch(batch); }

    /// Writes the footer; afterwards all rows are in the file. `sync`: waits until it is on the disk.
    arrow::Status finish(bool sync);

    /// Copies the rows of this finished Feather file into another format, with a schema that may have other metadata.
    /// The copy gets the name of this file, which has none afterwards, even on failure.
    arrow::Result<std::unique_ptr<CompleteFile>> copy_with(std::shared_ptr<arrow::Schema> const& schema,
                                                           TableFormat format, LockedFile const& unfinished, bool sync);

    /// Replaces the unfinished file, even if that was removed, with the finished one: by renaming it, or else by
    /// copying its bytes. Fails if another file is there now.
    arrow::Status take_the_place_of(LockedFile const& unfinished);

    /// Gives the finished file a name that was free, and that no later run uses: beside the unfinished one, else in the
    /// folder for temporary files. Returns its path.
    arrow::Result<std::filesystem::path> keep_beside(LockedFile const& unfinished);

private:
    CompleteFile(std::filesystem::path path, int descriptor);

    static arrow::Result<std::unique_ptr<CompleteFile>> make(LockedFile const& unfinished);
    bool can_be_renamed_to(LockedFile const& unfinished) const;
    arrow::Status copy_to(int descriptor) const;
    arrow::Result<std::filesystem::path> copy_to_new(std::filesystem::path const& path, int descriptor) const;

    std::filesystem::path path_;  // beside the unfinished one; empty: it has no name
    std::optional<ScratchFile> scratch_;
    int descriptor_;
    pid_t owner_;
    bool synced_ = false;
    std::shared_ptr<DescriptorStream> stream_;
    std::shared_ptr<arrow::ipc::RecordBatchWriter> writer_;
};

}  // namespace pogosim
