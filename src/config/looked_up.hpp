// What loading a configuration has found in files, so that another load knows whether it would find the same.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pogosim {

/// The type of the file at a path, which may be missing.
std::filesystem::file_type file_type_at(std::filesystem::path const& path);

/// The bytes of a file; empty if it cannot be read.
std::string bytes_at(std::filesystem::path const& path);

class LookedUp {
public:
    void note_text(std::filesystem::path const& path, std::string const& text) { texts_.push_back({path, text}); }
    void note_type(std::filesystem::path const& path, std::filesystem::file_type type) {
        types_.push_back({path, type});
    }

    /// Whether the same is there now. Relative paths: of the working folder, which must be the same.
    bool is_still_there() const;

    /// Bytes of the texts.
    std::size_t size() const;

private:
    struct Text {
        std::filesystem::path path;
        std::string text;
    };
    struct Type {
        std::filesystem::path path;
        std::filesystem::file_type type;
    };
    std::vector<Text> texts_;
    std::vector<Type> types_;
};

/// While this exists, what this thread looks up is noted.
class LookedUpScope {
public:
    explicit LookedUpScope(LookedUp& looked_up);
    ~LookedUpScope();
    LookedUpScope(LookedUpScope const&) = delete;
    LookedUpScope& operator=(LookedUpScope const&) = delete;

private:
    LookedUp* before_;
};

/// Tells the scope of this thread, if it has one, what was read.
void note_text_of(std::filesystem::path const& path, std::string const& text);

/// Whether there is a file or folder at the path; noted for the scope of this thread.
bool look_for(std::filesystem::path const& path);

/// The same for a folder.
bool look_for_folder(std::filesystem::path const& path);

}  // namespace pogosim
