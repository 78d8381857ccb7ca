#include "exitance/io/pictures/text.hpp"

#include <algorithm>
#include <cmath>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

/// The font file, which the build embeds (cmake/font.cmake).
extern "C" const unsigned char exitance_font_begin[], exitance_font_end[];

namespace exitance {
namespace {

/// A font size, opened for one text. Outlines are not hinted, so that letters have the same shape at every size.
class Font {
  public:
    explicit Font(int size) {
        if (FT_Init_FreeType(&library_) != 0) return;
        const FT_Long bytes = exitance_font_end - exitance_font_begin;
        if (FT_New_Memory_Face(library_, exitance_font_begin, bytes, 0, &face_) != 0) return;
        is_open_ = FT_Set_Pixel_Sizes(face_, 0, static_cast<FT_UInt>(size)) == 0;
    }
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;
    ~Font() {
        if (library_) FT_Done_FreeType(library_);  // also releases the face
    }

    static constexpr FT_ULong last_ascii = 0x7f;

    /// The letter at a place of UTF-8. Letters of two bytes, up to U+07FF, have Europe's accents; others are read byte
    /// by byte.
    static FT_ULong letter_at(std::string_view text, std::size_t i) {
        const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(k < text.size() ? text[k] : 0); };
        const bool is_pair = (byte(i) & 0xe0u) == 0xc0u && (byte(i + 1) & 0xc0u) == 0x80u;
        return is_pair ? (byte(i) & 0x1fu) << 6 | (byte(i + 1) & 0x3fu) : byte(i) & last_ascii;
    }

    /// Calls visit(bitmap, left, above) for each letter: its coverage, the column of the bitmap's left side, and the
    /// rows from the bitmap's top down to the baseline. Returns the width of the text in pixels.
    template <class Visit>
    int lay_out(std::string_view text, const Visit& visit) const {
        if (!is_open_) return 0;
        constexpr FT_Pos pixel = 64;  // FreeType's unit of lengths is 1/64 of a pixel
        constexpr FT_ULong raised_two = 0xb2;
        FT_Pos pen = 0;
        for (std::size_t i = 0; i < text.size(); ++i) {
            const bool raises = text.substr(i, 2) == "^2";
            const FT_ULong letter = raises ? raised_two : letter_at(text, i);
            if (raises || letter > last_ascii) ++i;
            if (FT_Load_Char(face_, letter, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0) continue;
            FT_GlyphSlot glyph = face_->glyph;
            const FT_Pos advance = glyph->advance.x;
            FT_Outline_Translate(&glyph->outline, pen % pixel, 0);
            if (FT_Render_Glyph(glyph, FT_RENDER_MODE_NORMAL) == 0)
                visit(glyph->bitmap, static_cast<int>(pen / pixel) + glyph->bitmap_left, glyph->bitmap_top);
            pen += advance;
        }
        return static_cast<int>((pen + pixel - 1) / pixel);
    }

  private:
    FT_Library library_ = nullptr;
    FT_Face face_ = nullptr;
    bool is_open_ = false;
};

/// Mixes a colour into a pixel of the picture; `coverage` is in [0, 255].
void mix(Image& image, int x, int y, Rgb colour, int coverage) {
    if (coverage == 0 || x < 0 || y < 0 || x >= image.width || y >= image.height) return;
    std::uint8_t* pixel = image.at(x, y);
    for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>((pixel[c] * (255 - coverage) + colour[c] * coverage + 127) / 255);
}

}  // namespace

int text_width(std::string_view text, int size) {
    return Font(size).lay_out(text, [](const FT_Bitmap&, int, int) {});
}

void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour) {
    for (int j = std::max(y, 0); j < std::min(y + height, image.height); ++j)
        for (int i = std::max(x, 0); i < std::min(x + width, image.width); ++i)
            std::copy(colour.begin(), colour.end(), image.at(i, j));
}

void draw_text(Image& image, int x, int y, std::string_view text, int size, Rgb colour) {
    constexpr double capital = 0.729;  // height of DejaVu Sans' capital letters per em
    const int baseline = y + static_cast<int>(std::lround(capital * size));
    Font(size).lay_out(text, [&](const FT_Bitmap& bitmap, int left, int above) {
        for (int row = 0; row < static_cast<int>(bitmap.rows); ++row)
            for (int column = 0; column < static_cast<int>(bitmap.width); ++column)
                mix(image, x + left + column, baseline - above + row, colour,
                    bitmap.buffer[row * bitmap.pitch + column]);
    });
}

}  // namespace exitance
