#include "render/film_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.hpp"
#include "base/scratch_file.hpp"
#include "render/film_format.hpp"
#include "render/png_file.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kLongestMessage = 400;

[[noreturn]] void refuse(std::filesystem::path const& path, std::string const& reason) {
    throw ConfigError(
        fmt::format("--video: the film '{}' cannot be written: {}; choose another file", path.string(), reason));
}

/// ffmpeg's own limit on the size of pictures (av_image_check_size), which it would report only with the first picture.
void check_size(PictureSize size) {
    constexpr std::int64_t kMargin = 128;
    constexpr std::int64_t kMostPixels = (std::int64_t{1} << 31U) / 8;
    if ((size.width_px + kMargin) * (size.height_px + kMargin) >= kMostPixels) {
        throw ConfigError(fmt::format(
            "--video: pictures of {} x {} pixels (window_width, window_height) are too large for ffmpeg, which takes "
            "some 16000 x 16000; make them smaller",
            size.width_px, size.height_px));
    }
}

/// Opens the file in which the film is put together. Throws ConfigError.
LockedFile open_beside(std::filesystem::path const& path, std::filesystem::path const& target) {
    std::error_code error;
    std::filesystem::create_directories(target.parent_path(), error);
    if (error) {
        refuse(path, error.message());
    }
    if (std::filesystem::exists(target, error)) {
        if (!std::filesystem::is_regular_file(target, error)) {
            refuse(path, "this is not a regular file");
        }
        if (access(target.c_str(), W_OK) != 0) {
            refuse(path, std::generic_category().message(errno));
        }
    }
    try {
        return LockedFile(FilmFile::path_beside(path));
    } catch (FileError const& reason) {
        refuse(path, reason.what());
    }
}

std::vector<std::string> ffmpeg_arguments(PictureSize size, FilmFormat const& format,
                                          std::filesystem::path const& film) {
    constexpr bool kLittle = std::endian::native == std::endian::little;
    std::vector<std::string> arguments{"-hide_banner",
                                       "-loglevel",
                                       "error",
                                       "-nostdin",
                                       "-y",
                                       "-f",
                                       "rawvideo",
                                       "-pixel_format",
                                       kLittle ? "bgr0" : "0rgb",
                                       "-video_size",
                                       fmt::format("{}x{}", size.width_px, size.height_px),
                                       "-framerate",
                                       std::to_string(kFilmHz),
                                       "-i",
                                       "pipe:0"};
    arguments.insert(arguments.end(), format.arguments.begin(), format.arguments.end());
    arguments.push_back("file:" + film.string());
    return arguments;
}

/// The end of what ffmpeg printed, in one line.
std::string in_one_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) {
        text.pop_back();
    }
    if (text.size() > kLongestMessage) {
        text = "..." + text.substr(text.size() - kLongestMessage);
    }
    for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i)) {
        text.replace(i, 1, "; ");
    }
    return text.empty() ? "it ended without a message" : text;
}

}  // namespace

std::filesystem::path FilmFile::path_beside(std::filesystem::path const& path) {
    return real_path(path).native() + kUnfinishedSuffix;
}

FilmFile::FilmFile(std::filesystem::path const& path, PictureSize size) : path_(path), target_(real_path(path)) {
    FilmFormat const& format = film_format(path);
    check_size(size);
    check_ffmpeg(format);
    unfinished_ = open_beside(path, target_);
    try {
        process_ = std::make_unique<FilmProcess>(ffmpeg_arguments(size, format, unfinished_.path()));
    } catch (FileError const& error) {
        throw ConfigError(fmt::format("--video: ffmpeg cannot be started: {}", error.what()));
    }
}

FilmFile::~FilmFile() {
    if (process_) {
        give_up();
    }
}

void FilmFile::give_up() {
    process_.reset();
    if (unfinished_.is_still_there()) {
        unlink(unfinished_.path().c_str());
    }
    unfinished_ = LockedFile();
}

void FilmFile::fail() {
    process_->finish();
    std::string const text = process_->output();
    give_up();
    throw FileError("ffmpeg: " + in_one_line(text));
}

void FilmFile::add(Canvas const& picture, std::int64_t times) {
    has_pictures_ = true;
    for (std::int64_t i = 0; i < times; ++i) {
        if (!process_->write(std::as_bytes(picture.pixels()))) {
            fail();
        }
    }
}

void FilmFile::finish() {
    if (!process_) {
        return;
    }
    if (!has_pictures_) {
        give_up();
        return;
    }
    if (!process_->finish()) {
        fail();
    }
    process_.reset();
    std::error_code error;
    if (std::filesystem::file_size(unfinished_.path(), error) == 0 || error) {
        give_up();
        throw FileError("ffmpeg: it ended without writing anything");
    }
    if (std::rename(unfinished_.path().c_str(), target_.c_str()) != 0) {
        int const reason = errno;
        give_up();
        fail_with_errno(reason);
    }
    unfinished_.keep();
    unfinished_ = LockedFile();
}

}  // namespace pogosim
