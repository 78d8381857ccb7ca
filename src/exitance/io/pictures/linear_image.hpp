#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/measure/pictures/picture.hpp"

namespace exitance {

/// A picture as numbers: one plane per channel, rows from top to bottom.
struct LinearImage {
    struct Channel {
        std::string name;  ///< "R", "irradiance.G", ...
        std::vector<float> values;
    };
    int width = 0, height = 0;
    std::vector<Channel> channels;
};

/// Facts stored with a picture, as pairs of name and text.
using ImageFacts = std::vector<std::pair<std::string, std::string>>;

/// Converts a picture to linear channels: radiance B / pi, W/(m^2 sr), as R, G and B, averaged over each pixel, where
/// parts without a front count as black; A is the share of the pixel that shows a surface; irradiance.R, G and B is E,
/// W/m^2, averaged over the part that shows fronts.
LinearImage linear_image(const Picture& picture);

/// Number format of a file: 32 bits; or 16 bits with a relative error of 2^-11, which limits values to 65504.
enum class Precision { single, half };

/// Writes OpenEXR, ZIP-compressed, with linear Rec. 709 primaries. The facts become string attributes. The file appears
/// whole or not at all.
Result<void> write_exr(const std::string& path, const LinearImage& image, const ImageFacts& facts,
                       Precision precision = Precision::single);

/// Writes Radiance's picture format with only R, G and B: a common exponent per pixel ([Ward91], relative error below
/// 1%), run-length encoded, exposure 1 (values are W/(m^2 sr)), sRGB primaries. The facts become comments.
Result<void> write_hdr(const std::string& path, const LinearImage& image, const ImageFacts& facts);

}  // namespace exitance
