#include "render/film_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <span>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.hpp"
#include "base/locked_file.hpp"
#include "base/scratch_file.hpp"
#include "render/film_process.hpp"
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

namespace {

constexpr auto kHowToInstall = "'sudo apt install ffmpeg' on Debian and Ubuntu, 'brew install ffmpeg' on macOS";

// Most players want even sizes, and colours as in high-definition video.
constexpr auto kForPlayers = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv";

/// A palette for each picture: one for all would need all pictures in memory.
constexpr auto kPalettes = "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=none";

std::vector<std::string> video_arguments(std::vector<std::string> const& of_encoder) {
    std::vector<std::string> arguments{"-vf",         kForPlayers, "-pix_fmt",         "yuv420p",
                                       "-colorspace", "bt709",     "-color_primaries", "bt709",
                                       "-color_trc",  "bt709",     "-color_range",     "tv"};
    arguments.insert(arguments.end(), of_encoder.begin(), of_encoder.end());
    return arguments;
}

std::array<FilmFormat, 3> const& formats() {
    static std::array<FilmFormat, 3> const all{
        FilmFormat{".mp4", "libx264",
                   video_arguments(
                       {"-c:v", "libx264", "-preset", "fast", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"})},
        FilmFormat{".webm", "libvpx-vp9",
                   video_arguments({"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-deadline", "good", "-cpu-used",
                                    "5", "-row-mt", "1", "-f", "webm"})},
        FilmFormat{".gif", "gif", {"-vf", kPalettes, "-loop", "0", "-f", "gif"}},
    };
    return all;
}

std::string in_lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Lines of `ffmpeg -encoders`: " V....D libx264   libx264 H.264 / AVC ...".
bool has_encoder(std::string const& listed, std::string const& encoder) {
    std::istringstream lines(listed);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string flags;
        std::string name;
        if (words >> flags >> name && name == encoder) {
            return true;
        }
    }
    return false;
}

}  // namespace

FilmFormat const& film_format(std::filesystem::path const& path) {
    auto const format = std::ranges::find(formats(), in_lower_case(path.extension()), &FilmFormat::ending);
    if (format == formats().end()) {
        throw ConfigError(
            fmt::format("--video: expected a name that ends in .mp4, .webm or .gif, found '{}'", path.string()));
    }
    return *format;
}

void check_ffmpeg(FilmFormat const& format) {
    std::string encoders;
    try {
        FilmProcess process({"-hide_banner", "-loglevel", "error", "-encoders"});
        process.finish();
        encoders = process.output();
    } catch (FileError const& error) {
        throw ConfigError(fmt::format("--video needs ffmpeg, which cannot be started ({}); install it: {}",
                                      error.what(), kHowToInstall));
    }
    if (!has_encoder(encoders, format.encoder)) {
        throw ConfigError(fmt::format(
            "--video: this ffmpeg has no encoder '{}', which {} films need; choose another ending (.mp4, .webm or "
            ".gif), or install a complete ffmpeg: {}",
            format.encoder, format.ending, kHowToInstall));
    }
}

}  // namespace pogosim
