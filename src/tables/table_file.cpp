#include "tables/table_file.hpp"

#include <arrow/api.h>
#include <arrow/array/concatenate.h>
#include <arrow/util/key_value_metadata.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <exception>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/save_progress.hpp"
#include "base/table_format.hpp"
#include "base/utf8.hpp"
#include "record/paths_beside.hpp"
#include "tables/complete_file.hpp"
#include "tables/metadata_beside.hpp"
#include "tables/table_writer.hpp"
#include "tables/unfinished_file.hpp"

namespace pogosim {

using arrow::Status;

namespace {

/// Throws OutputError with the path and the reason.
[[noreturn]] void fail(TableKind const& kind, std::string const& path, std::string const& reason) {
    throw OutputError(fmt::format("cannot write the {} '{}' ({}): {}", kind.name, path, kind.key, reason));
}

/// The reason of a failure: in our own words if it is the system's, else in the library's.
std::string reason_of(Status const& status) {
    if (status.IsOutOfMemory()) {
        return "there is not enough memory for its rows";
    }
    return status.IsIOError() ? status.message() : "the rows cannot be stored: " + status.message();
}

std::string not_a_file(TableKind const& kind) {
    return fmt::format("it is a device, a pipe or a socket, not a file; to run without a {}: {}", kind.name,
                       kind.how_to_do_without);
}

void make_parent_folder(TableKind const& kind, std::string const& path) {
    auto const parent = std::filesystem::path(path).parent_path();
    std::error_code error;
    if (!parent.empty() && !std::filesystem::create_directories(parent, error) && error) {
        fail(kind, path, "cannot make the folder '" + parent.string() + "': " + error.message());
    }
}

std::filesystem::file_type type_of(std::string const& path) {
    std::error_code error;
    return std::filesystem::status(path, error).type();
}

/// Throws OutputError for paths that are not files, such as block devices. Opening a pipe would wait for its reader.
void check_type_of_file(TableKind const& kind, std::string const& path) {
    using std::filesystem::file_type;
    auto const type = type_of(path);
    if (type == file_type::fifo || type == file_type::socket || type == file_type::block) {
        fail(kind, path, not_a_file(kind));
    }
}

/// The format that the name says; Feather if that is none.
TableFormat format_of(std::string const& path) {
    return table_format(path).value_or(TableFormat::feather);
}

/// Throws OutputError if the format that the name says cannot be written, or the place of the metadata is taken.
void check_format(TableKind const& kind, std::string const& path) {
    auto const format = format_of(path);
    if (auto const status = check_can_write(format); !status.ok()) {
        fail(kind, path, status.message());
    }
    if (format == TableFormat::csv && MetadataBeside::is_taken(path)) {
        fail(kind, path,
             fmt::format(
                 "its metadata belong in '{}', but a file that Pogosim did not write is already there; move it, or "
                 "choose another name",
                 metadata_path_of(path).string()));
    }
    if (format == TableFormat::csv && !MetadataBeside::has_short_name(path)) {
        fail(kind, path, "the name is too long for the file of metadata beside it; choose a shorter one");
    }
}

std::shared_ptr<arrow::KeyValueMetadata> make_metadata(TableFileOptions const& options) {
    auto metadata = std::make_shared<arrow::KeyValueMetadata>();
    for (auto const& [key, value] : options.metadata) {
        metadata->Append(key, replace_malformed(value));
    }
    return metadata;
}

/// Rows in several pieces.
struct Pieces {
    arrow::RecordBatchVector batches;
    std::int64_t row_count = 0;

    void add(std::shared_ptr<arrow::RecordBatch> const& batch) {
        batches.push_back(batch);
        row_count += batch->num_rows();
    }

    /// The first `count` rows, up to those of the first piece.
    void drop_first(std::int64_t count) {
        row_count -= count;
        if (count < batches.front()->num_rows()) {
            batches.front() = batches.front()->Slice(count);
        } else {
            batches.erase(batches.begin());
        }
    }

    /// All rows in one batch.
    arrow::Result<std::shared_ptr<arrow::RecordBatch>> joined(arrow::MemoryPool* memory) const {
        if (batches.size() == 1) {
            return batches.front();
        }
        auto const& schema = batches.front()->schema();
        arrow::ArrayVector columns;
        for (int i = 0; i < schema->num_fields(); ++i) {
            arrow::ArrayVector parts;
            for (auto const& batch : batches) {
                parts.push_back(batch->column(i));
            }
            ARROW_ASSIGN_OR_RAISE(columns.emplace_back(), arrow::Concatenate(parts, memory));
        }
        return arrow::RecordBatch::Make(schema, row_count, std::move(columns));
    }
};

/// The rows of one time.
struct Moment {
    double time_s;
    std::int64_t row_end;  // rows of the whole run up to and with these
};

/// Decides when the unfinished file is due again.
class SaveClock {
public:
    using Clock = std::chrono::steady_clock;

    bool is_due() const { return Clock::now() >= next_; }

    /// Rows are synced to the disk, against power failures, once the run is old enough for that to matter.
    bool run_is_long() const { return Clock::now() - start_ >= kLongRun; }

    /// To be called when a save that began at `begin` is over. While a run is young, rows are saved whenever its age
    /// has doubled.
    void saved(Clock::time_point begin) {
        auto const now = Clock::now();
        Clock::duration const usual = std::min<Clock::duration>(now - start_, kUsualPeriod);
        next_ = now + std::min<Clock::duration>(std::max(usual, kLeastRatio * (now - begin)), kLongestPeriod);
    }

private:
    static constexpr std::chrono::milliseconds kFirst{10};
    static constexpr std::chrono::seconds kLongRun{1};
    static constexpr std::chrono::seconds kUsualPeriod{2};
    static constexpr std::chrono::seconds kLongestPeriod{4};  // on a slow disk
    static constexpr int kLeastRatio = 100;                   // of the time between two saves to the duration of one

    Clock::time_point start_ = Clock::now();
    Clock::time_point next_ = start_ + kFirst;
};

constexpr std::uint64_t kBytesPerCell = 8;
constexpr std::int64_t kMostUnsavedRows = 1 << 20;  // a bound on memory
// This many rows are written to the unfinished file at the end of a moment even if no save is due, without waiting for
// the disk: their memory is then used again, which costs less than memory that the system has to clear. Fewer at a time
// would cost more: each column of each piece is compressed for itself.
constexpr std::int64_t kMostBufferedRows = 65536;

}  // namespace

struct TableFile::Impl {
    TableKind kind;
    std::string path;  // as the user wrote it
    TableFormat format;
    LockedFile file;
    pid_t owner = getpid();
    std::int64_t flush_row_count;
    arrow::MemoryPool* memory;
    TakeCells take_cells;
    std::shared_ptr<arrow::Schema> schema;
    std::shared_ptr<arrow::Schema> final_schema;  // of the complete file: with metadata added during the run
    std::vector<std::string> added_keys;
    std::unique_ptr<UnfinishedFile> unfinished;
    std::unique_ptr<CompleteFile> complete;    // from the first full batch on
    std::unique_ptr<MetadataBeside> metadata;  // of a CSV file that is complete, until it has taken its place
    Pieces unsaved;                            // not yet in the unfinished file
    Pieces uncompleted;                        // not yet in the complete file
    std::vector<Moment> unsaved_moments;       // those of the unsaved rows and of the buffered ones
    SaveClock clock;
    std::int64_t row_count = 0;
    std::int64_t buffered_rows = 0;
    std::int64_t saved_rows = 0;
    double saved_time_s = 0.0;  // of the last saved row
    bool saved_moment_is_whole = true;
    bool awaits_sync = false;  // some of the saved rows
    bool open = false;         // also false after the first failure

    Impl(TableFileOptions const& options, LockedFile locked, arrow::FieldVector const& fields, TakeCells take)
        : kind(options.kind),
          path(options.path),
          format(format_of(options.path)),
          file(std::move(locked)),
          flush_row_count(options.flush_row_count),
          memory(options.memory),
          take_cells(std::move(take)) {
        assert(flush_row_count > 0);
        schema = arrow::schema(fields, make_metadata(options));
        final_schema = schema;
        auto started = UnfinishedFile::start(file.descriptor(), schema, memory);
        if (!started.ok()) {
            fail(kind, path, reason_of(started.status()));
        }
        // A device such as /dev/null accepts all bytes and stores none.
        if (type_of(path) == std::filesystem::file_type::character) {
            fail(kind, path, not_a_file(kind));
        }
        file.keep();
        unfinished = std::move(started).ValueUnsafe();
        open = true;
    }

    bool is_writable() const { return open && getpid() == owner; }

    /// Approximate size, uncompressed.
    std::uint64_t byte_count() const {
        return static_cast<std::uint64_t>(row_count) * static_cast<std::uint64_t>(schema->num_fields()) * kBytesPerCell;
    }

    std::int64_t room() const { return flush_row_count - buffered_rows - uncompleted.row_count; }

    void count_rows(double time_s, std::int64_t count) {
        buffered_rows += count;
        row_count += count;
        if (unsaved_moments.empty() || unsaved_moments.back().time_s != time_s) {
            unsaved_moments.push_back({time_s, row_count});
        }
        unsaved_moments.back().row_end = row_count;
    }

    /// The rows in the builders become a piece.
    Status cut() {
        if (buffered_rows == 0) {
            return Status::OK();
        }
        auto const rows = std::exchange(buffered_rows, 0);
        ARROW_ASSIGN_OR_RAISE(auto arrays, take_cells());
        for (auto& array : arrays) {
            array = array->Slice(0, rows);  // a row that found no memory has only some of its cells
        }
        auto const batch = arrow::RecordBatch::Make(schema, rows, std::move(arrays));
        unsaved.add(batch);
        uncompleted.add(batch);
        return Status::OK();
    }

    Status save() {
        if (!has_rows_to_save()) {
            return Status::OK();
        }
        auto const begin = SaveClock::Clock::now();
        ARROW_RETURN_NOT_OK(cut());
        ARROW_RETURN_NOT_OK(append_to_unfinished(row_count));
        if (clock.run_is_long()) {
            unfinished->sync();
        }
        awaits_sync = false;
        clock.saved(begin);
        return Status::OK();
    }

    std::int64_t new_row_count() const { return buffered_rows + unsaved.row_count; }
    bool has_rows_to_save() const { return new_row_count() > 0 || awaits_sync; }

    /// Writes the rows of whole moments to the unfinished file, without waiting for the disk. At the end of a moment: a
    /// piece that the end of a batch cut off there is written without its last moment, whose other rows stay where they
    /// are, so that the next batch is one piece.
    Status append_whole_moments() {
        if (unsaved.row_count < kMostBufferedRows) {
            ARROW_RETURN_NOT_OK(cut());
        }
        std::int64_t const cut_rows = row_count - buffered_rows;
        auto const last = std::ranges::find_if(unsaved_moments.rbegin(), unsaved_moments.rend(),
                                               [&](Moment const& moment) { return moment.row_end <= cut_rows; });
        return last != unsaved_moments.rend() ? append_to_unfinished(last->row_end) : Status::OK();
    }

    /// Up to `row_end` of the run.
    Status append_to_unfinished(std::int64_t row_end) {
        while (saved_rows < row_end) {
            auto const piece = unsaved.batches.front();
            std::int64_t const count = std::min(piece->num_rows(), row_end - saved_rows);
            ARROW_RETURN_NOT_OK(unfinished->append(*piece->Slice(0, count)));
            awaits_sync = true;
            unsaved.drop_first(count);
            note_saved_until(saved_rows + count);
        }
        return Status::OK();
    }

    void note_saved_until(std::int64_t row_end) {
        auto const last = std::ranges::find_if(unsaved_moments,
                                               [row_end](Moment const& moment) { return moment.row_end >= row_end; });
        note_saved(*last, row_end);
        unsaved_moments.erase(unsaved_moments.begin(), saved_moment_is_whole ? std::next(last) : last);
    }

    /// `last`: of the last of these rows.
    void note_saved(Moment const& last, std::int64_t row_end) {
        saved_rows = row_end;
        saved_time_s = last.time_s;
        saved_moment_is_whole = last.row_end == row_end;
    }

    /// If not all rows fit, on the disk or in memory, as many of the first moments as possible are kept.
    Status save_what_fits() {
        ARROW_RETURN_NOT_OK(cut());
        std::int64_t first_row = saved_rows;  // of the piece
        for (auto const& piece : unsaved.batches) {
            if (!save_what_fits(*piece, first_row)) {
                break;
            }
            first_row += piece->num_rows();
        }
        return Status::OK();
    }

    /// The same for the rows from `first_row` of the run on. True when all of them fitted.
    bool save_what_fits(arrow::RecordBatch const& piece, std::int64_t first_row) {
        std::int64_t const row_end = first_row + piece.num_rows();
        std::int64_t written_end = first_row;
        std::span<Moment const> left(unsaved_moments);
        while (!left.empty() && left.front().row_end <= first_row) {
            left = left.subspan(1);
        }
        for (auto count = left.size(); count > 0;) {
            Moment const& last = left[count - 1];
            auto const end = std::min(last.row_end, row_end);
            auto const rows = piece.Slice(written_end - first_row, end - written_end);
            if (status_of([&] { return unfinished->append(*rows); }).ok()) {
                written_end = end;
                note_saved(last, end);
                left = left.subspan(count);
                count = end < row_end ? std::min(count, left.size()) : 0;
            } else {
                count /= 2;
            }
        }
        return written_end == row_end;
    }

    /// Moves rows to the complete file.
    Status add_to_complete(std::shared_ptr<arrow::Schema> const& complete_schema) {
        if (!complete) {
            ARROW_ASSIGN_OR_RAISE(complete, CompleteFile::start(file, complete_schema, memory));
        }
        if (uncompleted.row_count == 0) {
            return Status::OK();
        }
        ARROW_ASSIGN_OR_RAISE(auto const batch, uncompleted.joined(memory));
        ARROW_RETURN_NOT_OK(complete->append(*batch));
        uncompleted = {};
        return Status::OK();
    }

    /// `is_converted`: into the format that the user wants.
    Status finish(bool is_converted) {
        ARROW_RETURN_NOT_OK(cut());
        bool const lacks_metadata = complete && !added_keys.empty();
        ARROW_RETURN_NOT_OK(add_to_complete(final_schema));
        ARROW_RETURN_NOT_OK(complete->finish(clock.run_is_long()));
        if (is_converted && format != TableFormat::feather) {
            ARROW_ASSIGN_OR_RAISE(complete, complete->copy_with(final_schema, format, file, clock.run_is_long()));
        } else if (lacks_metadata) {
            replace_schema_of_complete();
        }
        if (is_converted && format == TableFormat::csv) {
            ARROW_ASSIGN_OR_RAISE(metadata, MetadataBeside::write(file.path(), *final_schema, clock.run_is_long()));
        }
        return Status::OK();
    }

    /// Copies a complete file that was begun before metadata were added. If the copy fails, the file lacks them, but no
    /// rows.
    void replace_schema_of_complete() {
        auto copy = complete->copy_with(final_schema, TableFormat::feather, file, clock.run_is_long());
        if (copy.ok()) {
            complete = std::move(copy).ValueUnsafe();
        } else {
            log().warn("the metadata of the {} '{}' lack the entry '{}': {}", kind.name, path,
                       fmt::join(added_keys, ", "), reason_of(copy.status()));
        }
    }

    /// After a failure, only the unfinished file remains.
    template <typename Action>
    void check(Action const& action) {
        auto const status = status_of(action);
        if (status.ok()) {
            return;
        }
        open = false;
        complete.reset();  // makes room on a full disk
        std::string const reason = reason_of(status);
        [[maybe_unused]] auto const last_try = status_of([this] { return save_what_fits(); });
        if (saved_rows == 0) {
            fail(kind, path, reason);
        }
        fail(kind, path,
             fmt::format("{}. It contains the rows up to t = {:.4f} s{}; to complete it, free some disk space and run: "
                         "pogosim-recover '{}'",
                         reason, saved_time_s, saved_moment_is_whole ? "" : ", and not all of that time", path));
    }

    /// If the complete file cannot replace the unfinished one, it stays beside it under a name of its own.
    [[noreturn]] void fail_beside(std::string const& reason) {
        auto const kept = complete->keep_beside(file);
        complete.reset();
        if (kept.ok() && metadata) {
            [[maybe_unused]] Status const last_try = metadata->belong_to(*kept);
        }
        if (!kept.ok()) {
            fail(kind, path,
                 fmt::format("{}. The rows of this run are lost: they cannot be written next to it: {}", reason,
                             reason_of(kept.status())));
        }
        fail(kind, path, fmt::format("{}. The rows of this run are in '{}'", reason, kept->string()));
    }
};

LockedFile TableFile::reserve(TableKind const& kind, std::string const& path) {
    make_parent_folder(kind, path);
    check_type_of_file(kind, path);
    check_format(kind, path);
    try {
        return LockedFile(path);
    } catch (FileError const& error) {
        fail(kind, path, error.what());
    }
}

TableFile::TableFile(TableFileOptions const& options, LockedFile file, arrow::FieldVector const& fields, TakeCells take)
    : impl_(std::make_unique<Impl>(options, std::move(file), fields, std::move(take))) {}

TableFile::~TableFile() {
    try {
        close();
    } catch (std::exception const& error) {
        log().error("{}", error.what());
    }
}

std::size_t TableFile::room() const {
    return static_cast<std::size_t>(std::max<std::int64_t>(impl_->room(), 1));  // a forked child saves nothing
}

void TableFile::count_rows(double time_s, std::size_t count, Status const& added) {
    assert(impl_->open);
    impl_->check([&] { return added; });
    impl_->count_rows(time_s, static_cast<std::int64_t>(count));
    if (impl_->room() == 0 && impl_->is_writable()) {
        impl_->check([&] { return impl_->cut(); });
        impl_->check([&] { return impl_->add_to_complete(impl_->schema); });
        if (impl_->unsaved.row_count >= kMostUnsavedRows) {
            impl_->check([&] { return impl_->save(); });
        }
    }
}

void TableFile::save_if_due() {
    if (impl_->has_rows_to_save() && impl_->clock.is_due()) {
        save();
    } else if (impl_->new_row_count() >= kMostBufferedRows && impl_->is_writable()) {
        impl_->check([&] { return impl_->append_whole_moments(); });
    }
}

void TableFile::save() {
    if (impl_->is_writable()) {
        impl_->check([&] { return impl_->save(); });
    }
}

void TableFile::add_metadata(std::string const& key, std::string const& value) {
    auto const metadata = impl_->final_schema->metadata()->Copy();
    metadata->Append(key, replace_malformed(value));
    impl_->final_schema = impl_->schema->WithMetadata(metadata);
    impl_->added_keys.push_back(key);
}

void TableFile::close() {
    if (!impl_->is_writable()) {
        return;
    }
    save_progress().bytes = impl_->byte_count();
    bool const is_ours = !impl_->unfinished->was_changed_by_others();
    if (is_ours) {
        impl_->check([&] { return impl_->save(); });
    }
    impl_->check([&] { return impl_->finish(/*is_converted=*/is_ours); });
    impl_->open = false;
    if (!is_ours) {
        impl_->fail_beside("its size is not what was written; did another program change it?");
    }
    if (std::error_code error; !std::filesystem::exists(impl_->file.path(), error)) {
        log().warn("another program removed the {} '{}' during the run; it is written again", impl_->kind.name,
                   impl_->path);
    }
    if (auto const status = impl_->complete->take_the_place_of(impl_->file); !status.ok()) {
        impl_->fail_beside(reason_of(status));
    }
    if (impl_->metadata) {
        impl_->check([&] { return impl_->metadata->belong_to(impl_->file.path()); });
    }
}

std::int64_t TableFile::row_count() const {
    return impl_->row_count;
}

}  // namespace pogosim
