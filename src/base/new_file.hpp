// A file that replaces another one, or takes its place, at once as a whole.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/locked_file.hpp"
#include "base/scratch_file.hpp"

namespace pogosim {

/// Throws FileError.
void write_all(int descriptor, std::string_view bytes);

/// Makes the folders of a file that are not there. Throws FileError.
void make_parent_folder(std::filesystem::path const& path);

/// A file of its own name beside another one, whose place it takes when it is complete. All throw FileError.
class NewFile {
public:
    explicit NewFile(std::filesystem::path const& target);
    ~NewFile();
    NewFile(NewFile const&) = delete;
    NewFile& operator=(NewFile const&) = delete;

    /// Removes what processes that were killed have left beside a file. Nothing may be writing it.
    static void remove_unfinished(std::filesystem::path const& target);

    int descriptor() const { return descriptor_; }

    /// Replaces the other file, and has its permissions then.
    void replace(LockedFile const& other);

    /// Takes the place if it is free; else whatever stands there stays.
    void take_free_place();

private:
    void sync_folder() const;

    std::filesystem::path target_;
    std::string path_;
    std::optional<ScratchFile> scratch_;
    int descriptor_ = -1;
};

}  // namespace pogosim
