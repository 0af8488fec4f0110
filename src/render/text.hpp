// Text in pictures: glyphs from Dear ImGui's font atlas, which is used alone, without a window.
#pragma once

#include <map>
#include <memory>
#include <string_view>

#include "render/canvas.hpp"

namespace pogosim {

/// The file of the first sans-serif font found in the usual places of Linux and macOS; empty: none.
std::string_view system_font();

/// Draws text in UTF-8, of which it has the characters of Latin-1; others become question marks.
class Text {
public:
    Text();
    ~Text();
    Text(Text const&) = delete;
    Text& operator=(Text const&) = delete;

    /// Pixels from the first letter to behind the last, in a font of so many pixels from line to line.
    int width(std::string_view text, int size_px);

    /// The line's left end and top are at a whole pixel.
    void draw(Canvas& canvas, std::string_view text, int size_px, int left, int top, Pixel colour);

private:
    struct Face;

    Face& face(int size_px);

    std::map<int, std::unique_ptr<Face>> faces_;  // by size
};

}  // namespace pogosim
