#include "exitance/io/scenes/textures/face_colours.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// Multiplies the colour of a part by factors at its corners, which vary linearly in between.
void multiply(ColourRange& range, std::span<const Spectrum> factors) {
    const auto n = static_cast<double>(factors.size());
    for (std::size_t b = 0; b < bands; ++b) {
        double sum = 0, variance = 0, lowest = factors[0][b], highest = factors[0][b];
        for (const Spectrum& factor : factors) {
            sum += factor[b];
            lowest = std::min(lowest, factor[b]), highest = std::max(highest, factor[b]);
        }
        const double centre = sum / n;
        // Variance of a linear function over a triangle, computed from its values at the corners.
        for (const Spectrum& factor : factors) variance += (factor[b] - centre) * (factor[b] - centre) / (4 * n);
        range.deviation[b] = std::sqrt(std::pow(range.deviation[b], 2) * (centre * centre + variance) +
                                       std::pow(range.mean[b], 2) * variance);
        range.mean[b] *= centre, range.lowest[b] *= lowest, range.highest[b] *= highest;
    }
}

/// Statistics of the part of a picture that a polygon shows, for a material with the value `whole`.
ColourRange shown(const FacePicture& face, std::span<const std::uint32_t> corners, const Spectrum& whole) {
    if (!face.picture) return {whole, Spectrum(), whole, whole};
    std::vector<Vec2> outline;
    for (const std::uint32_t c : corners) outline.push_back(face.places[c]);
    const TextureArea::Part part = face.picture->part(outline, face.wrap_s, face.wrap_t);
    const auto scaled = [&](const TextureArea::Colour& c) { return whole * factor_of(c, *face.picture); };
    return {scaled(part.mean), scaled(part.deviation), scaled(part.lowest), scaled(part.highest)};
}

}  // namespace

Spectrum factor_of(const TextureArea::Colour& colour, const TextureArea& picture) {
    const TextureArea::Colour whole = picture.mean();
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) {
        // With one band, a colour is replaced by the mean of its channels.
        const auto value = [&](const TextureArea::Colour& c) {
            return bands == 1 ? (c[0] + c[1] + c[2]) / 3 : c[b * 3 / bands];
        };
        out[b] = value(whole) > 0 ? value(colour) / value(whole) : 0;
    }
    return out;
}

PartColour part_colour(const Material& material, const FaceColours& colours, std::span<const std::uint32_t> corners,
                       double whitest) {
    PartColour out{shown(colours.reflectance, corners, material.reflectance),
                   shown(colours.exitance, corners, material.exitance)};
    if (!colours.corner_factors.empty()) {
        std::vector<Spectrum> factors;
        for (const std::uint32_t c : corners) factors.push_back(colours.corner_factors[c]);
        multiply(out.reflectance, factors);
    }
    for (double& v : out.reflectance.mean.value) v = std::min(v, whitest);
    if (colours.coverage.picture) {
        std::vector<Vec2> outline;
        for (const std::uint32_t c : corners) outline.push_back(colours.coverage.places[c]);
        out.coverage = colours.coverage.picture->mean(outline, colours.coverage.wrap_s, colours.coverage.wrap_t)[0];
    }
    return out;
}

}  // namespace exitance
