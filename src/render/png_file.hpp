// Pictures as PNG files.
#pragma once

#include <filesystem>

#include "render/canvas.hpp"

namespace pogosim {

/// Where a picture is written until it is complete: beside its place, under a name of this process alone.
std::filesystem::path unfinished_png(std::filesystem::path const& path);

/// Writes a picture with 8 bits per channel, without alpha. The file is written under another name beside `path` and
/// renamed when it is complete, so that `path` is never half a picture. The same picture gives the same bytes. Throws
/// FileError.
void write_png(std::filesystem::path const& path, Canvas const& picture);

}  // namespace pogosim
