#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exitance/io/pictures/png.hpp"
#include "exitance/io/pictures/text.hpp"
#include "exitance/measure/pictures/picture.hpp"

namespace exitance {

/// Quantity of a picture in false colours: the mean of the bands, or their luminous mean, which is cd/m^2 or lx in
/// photometric scenes.
enum class Quantity { radiosity, irradiance, luminance, illuminance };

/// Name and unit of a quantity, such as "illuminance lx", for radiometric or photometric scenes.
std::string title(Quantity quantity, bool photometric);

enum class Palette { viridis, inferno, turbo, grey };

double value_of(const Pixel& pixel, Quantity quantity);

/// User options for a colour scale.
struct ScaleChoice {
    std::optional<std::pair<double, double>> range = {};  ///< Range of the scale; none: the range of the picture.
    bool by_ratio = false;  ///< Steps of equal ratio, whatever the range of light; false: as the range suggests.
    std::optional<std::size_t> bands = {};  ///< Number of colours; none: round steps.
    bool smooth = false;                    ///< Interpolates between colours.
    Palette palette = Palette::viridis;
};

/// A scale with one colour between each pair of ascending values. By default these are round numbers at equal distances
/// (1, 2 or 5 times a power of ten), or 1-2-5 steps if the values span more than a factor of thirty.
struct ColourScale {
    std::vector<double> steps;  ///< Ascending values, at least two.
    Palette palette = Palette::viridis;
    bool smooth = false;
    std::vector<std::string> names() const;

    /// Index of the colour of a value, in [0, steps.size() - 2]; values outside the scale get the first or last colour.
    std::size_t band(double value) const;
    std::size_t band_count() const { return steps.size() - 1; }
    /// Position of a value in the scale, from 0 to 1; each step has the same length, with linear interpolation inside.
    double place(double value) const;
    Rgb colour(double value) const;
};

/// Makes a scale for the surfaces in a picture. Emitters, which are much brighter, and 1% of the pixels at each end are
/// ignored.
ColourScale make_colour_scale(const Picture& picture, Quantity quantity, const ScaleChoice& choice = {});

/// Draws the picture in false colours, dark for low values; lightness rises evenly, except for turbo.
Image false_colour_image(const Picture& picture, Quantity quantity, const ColourScale& scale);

/// Draws a legend into the upper right corner, under a title that consists of the name and the unit.
void draw_legend(Image& image, const std::string& title, const ColourScale& scale);

}  // namespace exitance
