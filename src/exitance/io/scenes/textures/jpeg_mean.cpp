#include <cstddef>
#include <cstdio>

#include <jpeglib.h>

#include <csetjmp>
#include <vector>

#include "exitance/io/scenes/textures/texture_mean.hpp"

namespace exitance {
namespace {

constexpr std::uint64_t max_held_bytes = std::uint64_t(512) << 20;  ///< Memory limit, bytes.

struct Failure {
    jpeg_error_mgr manager;
    jpeg_progress_mgr progress;
    std::jmp_buf jump;
};

[[noreturn]] void fail(j_common_ptr info) {
    std::longjmp(reinterpret_cast<Failure*>(info->err)->jump, 1);
}
void ignore(j_common_ptr) {}

/// Stops decoding pictures with more scans than any program writes (ten): each scan costs a pass over the whole
/// picture.
void count_passes(j_common_ptr info) {
    constexpr int max_scans = 24;
    if (info->is_decompressor && reinterpret_cast<j_decompress_ptr>(info)->input_scan_number > max_scans) fail(info);
}

/// libjpeg reports errors by longjmp(): no object with a destructor may exist in this function.
template <class Rows>
bool decode_rows(jpeg_decompress_struct& info, Failure& failure, std::span<const std::uint8_t> file,
                 std::vector<std::uint8_t>& row, Rows& out) {
    if (setjmp(failure.jump)) return false;
    jpeg_create_decompress(&info);
    failure.progress.progress_monitor = count_passes;
    info.progress = &failure.progress;
    jpeg_mem_src(&info, file.data(), static_cast<unsigned long>(file.size()));
    jpeg_read_header(&info, TRUE);
    const std::uint64_t pixels = std::uint64_t(info.image_width) * info.image_height;
    if (pixels > max_texture_pixels) return false;
    // Pictures with several scans are held in memory, two bytes per coefficient, and every scan passes over all of
    // them. A file with less than 0.001 bits per pixel is rejected: no program compresses that much.
    const std::uint64_t held = pixels * 2 * static_cast<unsigned>(info.num_components);
    if (jpeg_has_multiple_scans(&info) && (held > max_held_bytes || pixels > 8000 * std::uint64_t(file.size())))
        return false;
    info.out_color_space = JCS_RGB;
    jpeg_start_decompress(&info);
    if (info.output_components != 3) return false;
    row.resize(std::size_t(3) * info.output_width);
    while (info.output_scanline < info.output_height) {
        std::uint8_t* rows[1] = {row.data()};
        jpeg_read_scanlines(&info, rows, 1);
        out.add(row.data(), info.output_width);
    }
    return true;
}

/// Collects all rows of a picture.
struct AllRows {
    TexturePixels pixels;
    void add(const std::uint8_t* rgb, std::size_t count) {
        pixels.rgb.insert(pixels.rgb.end(), rgb, rgb + 3 * count);
        pixels.width = count, ++pixels.height;
    }
};

template <class Rows>
bool decode(std::span<const std::uint8_t> file, Rows& out) {
    jpeg_decompress_struct info{};
    Failure failure{};
    info.err = jpeg_std_error(&failure.manager);
    failure.manager.error_exit = fail;
    failure.manager.output_message = ignore;
    std::vector<std::uint8_t> row;
    const bool done = decode_rows(info, failure, file, row, out);
    jpeg_destroy_decompress(&info);
    return done;
}

const Error unreadable{ErrorCode::bad_input, "is a JPEG that cannot be read", "", ""};

}  // namespace

Result<std::array<double, 3>> mean_of_jpeg(std::span<const std::uint8_t> file, const ByteCurve& curve) {
    MeanOfRows mean(curve);
    if (!decode(file, mean)) return unreadable;
    return mean.mean();
}

Result<TexturePixels> decode_jpeg(std::span<const std::uint8_t> file) {
    AllRows rows;
    if (!decode(file, rows)) return unreadable;
    return std::move(rows.pixels);
}

}  // namespace exitance
