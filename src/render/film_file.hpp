// A film that ffmpeg encodes while the run goes on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/locked_file.hpp"
#include "render/canvas.hpp"
#include "render/film_process.hpp"

namespace pogosim {

/// Pictures per second.
inline constexpr int kFilmHz = 30;

class FilmFile {
public:
    /// The film is written under another name beside `path`, and renamed when it is complete: an older film stays until
    /// then. Missing folders are made. Throws ConfigError for what can be known before the run: a wrong ending, no
    /// ffmpeg, a file that cannot be written.
    FilmFile(std::filesystem::path const& path, PictureSize size);

    /// Deletes a film that was not finished.
    ~FilmFile();

    FilmFile(FilmFile const&) = delete;
    FilmFile& operator=(FilmFile const&) = delete;

    /// Adds a picture for `times` / kFilmHz seconds. Throws FileError with ffmpeg's message.
    void add(Canvas const& picture, std::int64_t times);

    /// Completes the film; one without pictures is given up. Throws FileError with ffmpeg's message.
    void finish();

    std::filesystem::path const& path() const { return path_; }  // as given

    /// Where the film is put together.
    static std::filesystem::path path_beside(std::filesystem::path const& path);

private:
    [[noreturn]] void fail();
    void give_up();

    std::filesystem::path path_;
    std::filesystem::path target_;  // the real one
    LockedFile unfinished_;
    std::unique_ptr<FilmProcess> process_;  // none once the film is finished or given up
    bool has_pictures_ = false;
};

// The formats of films, by the ending of the file: .mp4, .webm, .gif.

struct FilmFormat {
    std::string ending;                  // ".mp4"
    std::string encoder;                 // of ffmpeg
    std::vector<std::string> arguments;  // of ffmpeg, between the input and the name of the film
};

/// Throws ConfigError if the path has none of the endings, in upper or lower case.
FilmFormat const& film_format(std::filesystem::path const& path);

/// Throws ConfigError if ffmpeg is not installed, or without the encoder. Takes about 0.1 s.
void check_ffmpeg(FilmFormat const& format);

}  // namespace pogosim
