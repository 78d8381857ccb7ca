#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace exitance {

/// Decodes a file of write_hdr() by the format's description.
inline std::vector<std::array<double, 3>> read_hdr(const std::string& content, std::size_t width, std::size_t height) {
    const std::string size = "\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
    std::size_t at = content.find(size) + size.size();
    const auto byte = [&] { return static_cast<std::uint8_t>(content.at(at++)); };
    std::vector<std::array<double, 3>> pixels;
    for (std::size_t y = 0; y < height; ++y) {
        std::vector<std::array<std::uint8_t, 4>> row(width);
        if (width < 8) {
            for (auto& pixel : row)
                for (auto& channel : pixel) channel = byte();
        } else {
            EXPECT_EQ(byte(), 2);
            EXPECT_EQ(byte(), 2);
            EXPECT_EQ(byte(), width >> 8);
            EXPECT_EQ(byte(), width & 255);
            for (std::size_t c = 0; c < 4; ++c)
                for (std::size_t x = 0; x < width;) {
                    std::size_t count = byte();
                    const bool run = count > 128;
                    if (run) count -= 128;
                    const std::uint8_t value = run ? byte() : 0;
                    for (; count > 0; --count) row.at(x++)[c] = run ? value : byte();
                }
        }
        for (const auto& p : row) {
            const double unit = p[3] ? std::ldexp(1.0, p[3] - 136) : 0;
            pixels.push_back({(p[0] + 0.5) * unit, (p[1] + 0.5) * unit, (p[2] + 0.5) * unit});
        }
    }
    EXPECT_EQ(at, content.size());
    return pixels;
}

}  // namespace exitance
