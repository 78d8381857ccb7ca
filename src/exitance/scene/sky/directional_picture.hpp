#pragma once

#include <cstddef>
#include <vector>

#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

/// A picture of all directions: azimuth by column, altitude by row (equirectangular). The middle column is the
/// direction +x, columns to the right turn clockwise seen from above, the first row is at the zenith.
struct DirectionalPicture {
    std::size_t width = 0, height = 0;
    std::vector<float> radiance;  ///< W/(m^2 sr), `bands` values per pixel, row by row from the top.
};

/// Returns the light of a picture that is turned by `rotation` degrees counter-clockwise seen from above. The picture
/// must have a pixel, and its values must be finite and not negative.
///
/// Small and very bright spots, such as the sun, become discs: radiance above the spot's surroundings is taken out of
/// the picture. The flux through a plane that faces a disc and the disc's direction are those of this radiance; its
/// solid angle is (sum e dw)^2 / sum e^2 dw, where e is the radiance above the surroundings. The remaining picture
/// becomes two domes per band with cells of 2.8 degrees (SkyPicture). Their irradiances of a horizontal plane are the
/// exact sums over the pixels. O(pixels).
DistantLight light_of_picture(DirectionalPicture picture, double rotation);

/// Returns the irradiance of a horizontal plane that faces up (or down, if `is_below`), W/m^2: the sum over pixels with
/// their exact weights.
Spectrum horizontal_irradiance(const DirectionalPicture& picture, bool is_below);

}  // namespace exitance
