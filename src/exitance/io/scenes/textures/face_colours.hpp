#pragma once

#include <span>
#include <vector>

#include "exitance/io/scenes/textures/texture_area.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A picture on a face.
struct FacePicture {
    const TextureArea* picture = nullptr;  ///< Null: the colour does not vary. The picture must outlive its users.
    std::vector<Vec2> places;              ///< Texture coordinates, one per corner of the face.
    TextureArea::Wrap wrap_s = TextureArea::Wrap::repeat, wrap_t = TextureArea::Wrap::repeat;
};

/// Colours of a face, as factors of those of its material, which has the means of the whole pictures.
struct FaceColours {
    FacePicture reflectance, exitance;
    FacePicture coverage;  ///< 1 where the face is opaque, 0 in holes.
    /// Factors of the reflectance at the corners of a triangle, linear in between; empty: 1.
    std::vector<Spectrum> corner_factors;

    bool vary() const { return reflectance.picture || exitance.picture || coverage.picture || !corner_factors.empty(); }
};

/// Statistics of a quantity over a face or a part of it, per band.
struct ColourRange {
    Spectrum mean, deviation;  ///< RMS deviation from the mean.
    Spectrum lowest, highest;
};

/// Reflectance and exitance (W/m^2) of a face or a part of it.
struct PartColour {
    ColourRange reflectance, exitance;
    double coverage = 1;  ///< Share of the area that is not in holes.
};

/// Converts a colour of a picture to a factor of the material's value: the colour divided by the mean of the picture; 0
/// in bands in which that is black.
Spectrum factor_of(const TextureArea::Colour& colour, const TextureArea& picture);

/// Returns the colour of the polygon whose corners are the given ones of a face, from 32 x 32 samples
/// (`TextureArea::part`).
/// corners  indices of corners of the face
/// whitest  upper limit of reflectances
PartColour part_colour(const Material& material, const FaceColours& colours, std::span<const std::uint32_t> corners,
                       double whitest);

}  // namespace exitance
