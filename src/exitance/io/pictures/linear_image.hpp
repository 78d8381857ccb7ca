#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/measure/pictures/picture.hpp"

namespace exitance {

/// A picture as numbers: one plane a channel, rows from top to bottom.
struct LinearImage {
    struct Channel {
        std::string name;  ///< "R", "irradiance.G", ...
        std::vector<float> values;
    };
    int width = 0, height = 0;
    std::vector<Channel> channels;
};

/// Facts stored with a picture: a name and a text.
using ImageFacts = std::vector<std::pair<std::string, std::string>>;

/// Radiance B / pi in W/(m^2 sr) as R, G and B, averaged over every pixel: what shows no front is black. A: the share
/// of a pixel that shows a surface. irradiance.R, G and B: E in W/m^2, averaged over what shows fronts.
LinearImage linear_image(const Picture& picture);

/// Of the numbers in a file: 32 bits; or 16 bits, relative error 2^-11, of which the largest is 65504: what is larger
/// becomes that.
enum class Precision { single, half };

/// OpenEXR, ZIP-compressed, linear Rec. 709 primaries; the facts become string attributes. Appears whole or not at all.
Result<void> write_exr(const std::string& path, const LinearImage& image, const ImageFacts& facts,
                       Precision precision = Precision::single);

/// Radiance's picture format, R, G and B alone: a shared exponent a pixel ([Ward91], relative error below 1%),
/// run-length encoded, exposure 1 (values are W/(m^2 sr)), sRGB primaries; the facts become comments.
Result<void> write_hdr(const std::string& path, const LinearImage& image, const ImageFacts& facts);

}  // namespace exitance
