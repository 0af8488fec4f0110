#include "render/film_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

#include "base/error.hpp"
#include "base/locked_file.hpp"
#include "render/film_process.hpp"

namespace pogosim {

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
