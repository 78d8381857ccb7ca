#include "exitance/io/png.hpp"

#include <png.h>

#include <csetjmp>

#include "exitance/io/atomic_file.hpp"

namespace exitance {
namespace {

void append(png_structp png, png_bytep bytes, png_size_t count) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}

void ignore_flush(png_structp) {}

/// libpng reports errors by a jump: nothing with a destructor may live in this function.
bool encode(png_structp png, png_infop info, const Image& image, png_textp texts, int text_count, std::string& out) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, &out, append, ignore_flush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
    if (text_count > 0) png_set_text(png, info, texts, text_count);
    png_write_info(png, info);
    for (int y = 0; y < image.height; ++y) png_write_row(png, image.at(0, y));
    png_write_end(png, info);
    return true;
}

}  // namespace

Result<void> write_png(const std::string& path, const Image& image, const ImageTexts& texts) {
    std::vector<png_text> entries;
    for (const auto& [key, text] : texts) {
        png_text entry{};
        entry.compression = PNG_TEXT_COMPRESSION_NONE;
        entry.key = const_cast<char*>(key.c_str());  // libpng copies it
        entry.text = const_cast<char*>(text.c_str());
        entry.text_length = text.size();
        entries.push_back(entry);
    }
    std::string content;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool done = info && encode(png, info, image, entries.data(), static_cast<int>(entries.size()), content);
    png_destroy_write_struct(&png, &info);
    if (!done) return Error{ErrorCode::cannot_write, "the picture cannot be encoded as PNG", path, ""};
    return write_file(path, content);
}

}  // namespace exitance
