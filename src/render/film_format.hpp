// The formats of films, by the ending of the file: .mp4, .webm, .gif.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pogosim {

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
