#pragma once

#include <string>
#include <vector>

#include "exitance/io/pictures/png.hpp"
#include "exitance/reconstruct/pictures/picture.hpp"

namespace exitance {

/// What a picture in false colours shows: the mean of the bands in W/m^2, or for scenes whose emitters are given in
/// cd/m^2 the weighted mean of the bands in cd/m^2 or lx (weights of linear sRGB, 0.2126, 0.7152, 0.0722, when there
/// are three).
enum class Quantity { radiosity, irradiance, luminance, illuminance };

/// The weighted mean of the bands.
double luminous_mean(const Spectrum& s);

double value_of(const Pixel& pixel, Quantity quantity);

/// Round values in rising order between which one colour stands each: equal steps (1, 2 or 5 times a power of ten), or
/// 1-2-5 steps where the light spans more than a factor of thirty.
struct ColourScale {
    std::vector<double> steps;  ///< At least two.
    std::vector<std::string> names() const;

    /// Which colour shows a value, in [0, steps.size() - 2]: what lies outside goes to the ends.
    std::size_t band(double value) const;
    std::size_t band_count() const { return steps.size() - 1; }
};

/// A scale for the surfaces in a picture; emitters, brighter by far, are left out, and so is one pixel in a hundred at
/// either end.
ColourScale make_colour_scale(const Picture& picture, Quantity quantity);

/// The picture in false colours, darkest first (viridis: lightness rises evenly).
Image false_colour_image(const Picture& picture, Quantity quantity, const ColourScale& scale);

/// Draws what the colours mean into the upper right corner.
void draw_legend(Image& image, Quantity quantity, const ColourScale& scale);

}  // namespace exitance
