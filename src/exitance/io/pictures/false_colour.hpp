#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exitance/io/pictures/bitmap_font.hpp"
#include "exitance/io/pictures/png.hpp"
#include "exitance/measure/pictures/picture.hpp"

namespace exitance {

/// What a picture in false colours shows: the mean of the bands, or the mean as the eye weighs them, which is cd/m^2 or
/// lx in photometric scenes.
enum class Quantity { radiosity, irradiance, luminance, illuminance };

/// "illuminance lx": its name, and its unit in scenes of watts or of lumens.
std::string title(Quantity quantity, bool photometric);

enum class Palette { viridis, inferno, turbo, grey };

double value_of(const Pixel& pixel, Quantity quantity);

/// What of a scale users choose.
struct ScaleChoice {
    std::optional<std::pair<double, double>> range = {};  ///< None: as the picture has it.
    bool by_ratio = false;                                ///< Steps of equal ratios; else where the light asks for it.
    std::optional<std::size_t> bands = {};                ///< So many colours; none: round steps.
    bool smooth = false;                                  ///< Colours run into one another.
    Palette palette = Palette::viridis;
};

/// Values in rising order between which one colour stands each: as a rule round ones at equal steps (1, 2 or 5 times a
/// power of ten), or 1-2-5 steps where the light spans more than a factor of thirty.
struct ColourScale {
    std::vector<double> steps;  ///< At least two.
    Palette palette = Palette::viridis;
    bool smooth = false;
    std::vector<std::string> names() const;

    /// Which colour shows a value, in [0, steps.size() - 2]: what lies outside goes to the ends.
    std::size_t band(double value) const;
    std::size_t band_count() const { return steps.size() - 1; }
    /// Where in the scale a value lies, from 0 to 1: between its steps, evenly from one to the next.
    double place(double value) const;
    Rgb colour(double value) const;
};

/// A scale for the surfaces in a picture; emitters, brighter by far, are left out, and so is one pixel in a hundred at
/// either end.
ColourScale make_colour_scale(const Picture& picture, Quantity quantity, const ScaleChoice& choice = {});

/// The picture in false colours, darkest first (but for turbo, lightness rises evenly).
Image false_colour_image(const Picture& picture, Quantity quantity, const ColourScale& scale);

/// Draws what the colours mean into the upper right corner, under a title: its name, then its unit.
void draw_legend(Image& image, const std::string& title, const ColourScale& scale);

}  // namespace exitance
