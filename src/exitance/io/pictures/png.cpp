#include "exitance/io/pictures/png.hpp"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/scenes/textures/texture_mean.hpp"

namespace exitance {
namespace {

void append(png_structp png, png_bytep bytes, png_size_t count) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}

void ignore_flush(png_structp) {}

/// libpng reports errors by longjmp(): no object with a destructor may exist in this function.
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

struct Source {
    std::span<const std::uint8_t> left;
};

void take(png_structp png, png_bytep out, png_size_t count) {
    auto& left = static_cast<Source*>(png_get_io_ptr(png))->left;
    if (count > left.size()) png_error(png, "ends early");
    std::memcpy(out, left.data(), count);
    left = left.subspan(count);
}

[[noreturn]] void fail(png_structp png, png_const_charp) {
    png_longjmp(png, 1);
}
void ignore_warning(png_structp, png_const_charp) {}

/// libpng reports errors by longjmp(): no object with a destructor may exist in this function.
bool decode_rows(png_structp png, png_infop info, Source& source, std::vector<std::uint8_t>& row, MeanOfRows& mean) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, &source, take);
    png_read_info(png, info);
    const png_uint_32 width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    if (std::uint64_t(width) * height > max_texture_pixels) return false;
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_strip_alpha(png);
    png_read_update_info(png, info);
    if (png_get_rowbytes(png, info) != std::size_t(3) * width) return false;
    row.resize(std::size_t(3) * width);
    const bool interlaced = png_get_interlace_type(png, info) == PNG_INTERLACE_ADAM7;
    // Each pass of an interlaced picture is a smaller picture; together they contain every pixel once.
    for (int pass = 0; pass < (interlaced ? PNG_INTERLACE_ADAM7_PASSES : 1); ++pass) {
        const png_uint_32 columns = interlaced ? PNG_PASS_COLS(width, pass) : width;
        const png_uint_32 rows = interlaced ? PNG_PASS_ROWS(height, pass) : height;
        if (columns == 0) continue;
        for (png_uint_32 y = 0; y < rows; ++y) {
            png_read_row(png, row.data(), nullptr);
            mean.add(row.data(), columns);
        }
    }
    return true;
}

}  // namespace

Result<std::string> encode_png(const Image& image, const ImageTexts& texts) {
    std::vector<png_text> entries;
    for (const auto& [key, text] : texts) {
        png_text entry{};
        entry.compression = PNG_TEXT_COMPRESSION_NONE;
        entry.key = const_cast<char*>(key.c_str());  // libpng copies the text, so it does not change it
        entry.text = const_cast<char*>(text.c_str());
        entry.text_length = text.size();
        entries.push_back(entry);
    }
    std::string content;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool done = info && encode(png, info, image, entries.data(), static_cast<int>(entries.size()), content);
    png_destroy_write_struct(&png, &info);
    if (!done) return Error{ErrorCode::cannot_write, "the picture cannot be encoded as PNG", "", ""};
    return content;
}

Result<void> write_png(const std::string& path, const Image& image, const ImageTexts& texts) {
    Result<std::string> content = encode_png(image, texts);
    if (content) return write_file(path, *content);
    Error error = content.error();
    error.where = path;
    return error;
}

Result<std::array<double, 3>> mean_of_png(std::span<const std::uint8_t> file, const ByteCurve& decode) {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    Source source{file};
    std::vector<std::uint8_t> row;
    MeanOfRows mean(decode);
    const bool done = info && decode_rows(png, info, source, row, mean);
    png_destroy_read_struct(&png, &info, nullptr);
    if (!done) return Error{ErrorCode::bad_input, "is a PNG that cannot be read", "", ""};
    return mean.mean();
}

Result<TexturePixels> decode_png(std::span<const std::uint8_t> file) {
    const Error unreadable{ErrorCode::bad_input, "is a PNG that cannot be read", "", ""};
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&image, file.data(), file.size())) return unreadable;
    if (std::uint64_t(image.width) * image.height > max_texture_pixels) return png_image_free(&image), unreadable;
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> rgba(std::size_t(4) * image.width * image.height);
    if (!png_image_finish_read(&image, nullptr, rgba.data(), 0, nullptr)) return unreadable;
    TexturePixels out{image.width, image.height, {}};
    out.rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 3; i < rgba.size(); i += 4) out.opacity.push_back(rgba[i]);
    if (std::all_of(out.opacity.begin(), out.opacity.end(), [](std::uint8_t a) { return a == 255; }))
        out.opacity.clear();
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        out.rgb.insert(out.rgb.end(), rgba.begin() + static_cast<std::ptrdiff_t>(i),
                       rgba.begin() + static_cast<std::ptrdiff_t>(i + 3));
    return out;
}

}  // namespace exitance
