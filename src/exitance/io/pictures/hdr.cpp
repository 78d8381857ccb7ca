#include <fmt/format.h>

#include <array>
#include <cmath>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/pictures/linear_image.hpp"

namespace exitance {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Encodes three mantissas of eight bits with a common exponent: value = mantissa 2^(exponent - 136).
Rgbe shared_exponent(float r, float g, float b) {
    const float largest = std::max({r, g, b});
    if (!(largest > 1e-32f)) return {0, 0, 0, 0};
    int exponent = 0;
    std::frexp(std::min(largest, 1e38f), &exponent);
    const auto mantissa = [&](float value) {
        return static_cast<std::uint8_t>(std::clamp(std::ldexp(value, 8 - exponent), 0.0f, 255.0f));
    };
    return {mantissa(r), mantissa(g), mantissa(b), static_cast<std::uint8_t>(exponent + 128)};
}

/// Encodes one byte of every pixel of a row. Runs of 4 to 127 equal bytes become (128 + length, byte); other bytes are
/// copied after their count, at most 128.
void encode_runs(const std::vector<std::uint8_t>& bytes, std::string& out) {
    const auto run_at = [&](std::size_t i) {
        std::size_t n = 1;
        while (i + n < bytes.size() && n < 127 && bytes[i + n] == bytes[i]) ++n;
        return n;
    };
    for (std::size_t i = 0; i < bytes.size();) {
        if (const std::size_t run = run_at(i); run >= 4) {
            out += static_cast<char>(128 + run);
            out += static_cast<char>(bytes[i]);
            i += run;
            continue;
        }
        std::size_t end = i;
        while (end < bytes.size() && end - i < 128 && run_at(end) < 4) ++end;
        out += static_cast<char>(end - i);
        out.append(reinterpret_cast<const char*>(bytes.data()) + i, end - i);
        i = end;
    }
}

}  // namespace

Result<void> write_hdr(const std::string& path, const LinearImage& image, const ImageFacts& facts) {
    std::string out = "#?RADIANCE\n";
    for (const auto& [name, text] : facts) out += fmt::format("# {}: {}\n", name, text);
    out += fmt::format(
        "EXPOSURE=1\nPRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n",
        image.height, image.width);
    const auto width = static_cast<std::size_t>(image.width);
    const bool runs = image.width >= 8 && image.width < 32768;  // the format allows runs only for these widths
    std::vector<Rgbe> row(width);
    std::vector<std::uint8_t> bytes(width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t i = y * width + x;
            row[x] =
                shared_exponent(image.channels[0].values[i], image.channels[1].values[i], image.channels[2].values[i]);
        }
        if (!runs) {
            for (const Rgbe& p : row) out.append(reinterpret_cast<const char*>(p.data()), p.size());
            continue;
        }
        for (const std::size_t byte : {std::size_t(2), std::size_t(2), width >> 8, width & 255})
            out += static_cast<char>(byte);
        for (std::size_t c = 0; c < 4; ++c) {
            for (std::size_t x = 0; x < width; ++x) bytes[x] = row[x][c];
            encode_runs(bytes, out);
        }
    }
    return write_file(path, out);
}

}  // namespace exitance
