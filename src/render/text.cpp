#include "render/text.hpp"

#include <imgui.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <string>

#include "base/library_folder.hpp"

namespace pogosim {

namespace {

constexpr std::array kFonts{
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
    "/usr/share/fonts/truetype/liberation2/LiberationSans-Regular.ttf",
    "/usr/share/fonts/liberation-sans/LiberationSans-Regular.ttf",
    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/noto/NotoSans-Regular.ttf",
    "/System/Library/Fonts/SFNS.ttf",
    "/System/Library/Fonts/Supplemental/Arial.ttf",
    "/Library/Fonts/Arial.ttf",
#ifdef POGOSIM_FONT_FROM_LIBRARY
    POGOSIM_FONT_FROM_LIBRARY,
#endif
};

/// Takes the first character off the text; '?' for what Latin-1 does not have, or is no UTF-8.
ImWchar next_character(std::string_view& text) {
    auto const byte = static_cast<unsigned char>(text[0]);
    std::size_t bytes = 1;
    while (byte >= 0x80U && bytes < text.size() && (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U) {
        ++bytes;
    }
    bool const is_latin_1 = bytes == 2 && (byte & 0xFCU) == 0xC0U;
    auto const second = bytes == 2 ? static_cast<unsigned char>(text[1]) : 0U;
    text.remove_prefix(bytes);
    if (byte < 0x80U) {
        return byte;
    }
    return is_latin_1 ? static_cast<ImWchar>((byte & 0x03U) << 6U | (second & 0x3FU)) : ImWchar{'?'};
}

}  // namespace

std::string_view system_font() {
    static std::string const found = [] {
        std::error_code ignored;
        for (char const* const font : kFonts) {
            std::filesystem::path const path = library_folder() / font;  // an absolute path stays as it is
            if (std::filesystem::is_regular_file(path, ignored)) {
                return path.string();
            }
        }
        return std::string{};
    }();
    return found;
}

namespace {

/// Allocates for ImGui, which does not check whether it got the memory.
void* allocate(std::size_t bytes, void* /*user_data*/) {
    void* const memory = std::malloc(bytes);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    return memory;
}

void release(void* memory, void* /*user_data*/) {
    std::free(memory);
}

}  // namespace

/// The letters of one size.
struct Text::Face {
#if IMGUI_VERSION_NUM >= 19200  // fonts have glyphs for each of several sizes
    using Glyphs = ImFontBaked;
    static Glyphs* glyphs_of(ImFont* font, float size_px) {
        return font->GetFontBaked(size_px);
    }
#else
    using Glyphs = ImFont;
    static Glyphs* glyphs_of(ImFont* font, float /*size_px*/) {
        return font;
    }
#endif

    ImFontAtlas atlas;
    Glyphs* glyphs = nullptr;
    unsigned char* opacity = nullptr;  // of the atlas's picture, row by row
    int atlas_width = 0;
    int atlas_height = 0;

    explicit Face(int size_px) {
        ImGui::SetAllocatorFunctions(allocate, release);
        auto const size = static_cast<float>(size_px);
        ImFontConfig config;
        config.SizePixels = size;
        config.OversampleH = 1;  // one pixel of the atlas for one of the picture
        config.OversampleV = 1;
        config.PixelSnapH = true;
        ImFont* font = nullptr;
        if (!system_font().empty()) {
            font = atlas.AddFontFromFileTTF(std::string(system_font()).c_str(), size, &config);
        }
        if (font == nullptr) {
            font = atlas.AddFontDefault(&config);
        }
        atlas.GetTexDataAsAlpha8(&opacity, &atlas_width, &atlas_height);
        glyphs = glyphs_of(font, size);
    }
};

Text::Text() = default;
Text::~Text() = default;

Text::Face& Text::face(int size_px) {
    auto& face = faces_[size_px];
    if (!face) {
        face = std::make_unique<Face>(size_px);
    }
    return *face;
}

int Text::width(std::string_view text, int size_px) {
    Face::Glyphs& glyphs = *face(size_px).glyphs;
    float width = 0.0F;
    while (!text.empty()) {
        width += glyphs.GetCharAdvance(next_character(text));
    }
    return static_cast<int>(std::ceil(width));
}

void Text::draw(Canvas& canvas, std::string_view text, int size_px, int left, int top, Pixel colour) {
    Face const& face = this->face(size_px);
    auto const columns = static_cast<float>(face.atlas_width);
    auto const rows = static_cast<float>(face.atlas_height);
    float pen = 0.0F;
    while (!text.empty()) {
        ImFontGlyph const* const glyph = face.glyphs->FindGlyph(next_character(text));
        if (glyph == nullptr) {
            continue;
        }
        auto const from_x = static_cast<int>(std::lround(glyph->U0 * columns));
        auto const from_y = static_cast<int>(std::lround(glyph->V0 * rows));
        auto const width = static_cast<int>(std::lround((glyph->U1 - glyph->U0) * columns));
        auto const height = static_cast<int>(std::lround((glyph->V1 - glyph->V0) * rows));
        canvas.stamp(face.opacity + static_cast<std::ptrdiff_t>(from_y) * face.atlas_width + from_x, width, height,
                     face.atlas_width, left + static_cast<int>(std::lround(pen + glyph->X0)),
                     top + static_cast<int>(std::lround(glyph->Y0)), colour);
        pen += glyph->AdvanceX;
    }
}

}  // namespace pogosim
