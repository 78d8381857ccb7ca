#pragma once

#include <string>

#include "exitance/base/result.hpp"
#include "exitance/scene/sky/directional_picture.hpp"

namespace exitance {

/// Width of the largest picture of all directions, pixels: it takes 400 MB.
constexpr std::size_t max_directional_width = 8192;

/// Reads a picture of all directions from .hdr (Radiance's RGBE) or .exr (OpenEXR), as its ending says. The picture
/// must be twice as wide as high, at most `max_directional_width` wide, and hold finite radiances that are not
/// negative. Errors: cannot_read; bad_input for other formats and wrong content.
Result<DirectionalPicture> read_directional_picture(const std::string& path);

/// The readers of the two formats. They check the size but not the values.
Result<DirectionalPicture> read_directional_hdr(const std::string& path);
Result<DirectionalPicture> read_directional_exr(const std::string& path);

/// Returns an error if a picture of that size is not one of all directions.
Result<void> check_directional_size(long long width, long long height, const std::string& path);

/// Appends a pixel to a picture, converted from red, green and blue to the bands.
void append_pixel(float r, float g, float b, DirectionalPicture& picture);

}  // namespace exitance
