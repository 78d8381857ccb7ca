#pragma once

#include <optional>
#include <span>

#include "exitance/io/scenes/textures/texture_area.hpp"

namespace exitance {

/// A picture with holes.
struct MaskedPicture {
    TextureArea colour;  ///< Holes have the mean of all opaque pixels, so that they hardly change the colour of parts.
    TextureArea coverage;  ///< 1 where the picture is opaque, 0 in holes.
};

/// Decodes a picture whose pixels are holes where their opacity is below `cutoff` (0 to 1). Empty if it has no holes.
/// Error: see `decode_texture`.
Result<std::optional<MaskedPicture>> decode_masked(std::span<const std::uint8_t> file, double cutoff,
                                                   const ByteCurve& decode);

/// Gives the holes of a picture the mean colour of the rest, as coded in the file. Nothing changes if it is opaque.
void fill_holes(TexturePixels& pixels, double cutoff);

/// Decodes a picture of opacity: that of its pixels or, if these are opaque, their red channel. Pixels below `cutoff`
/// are holes. Error: see `decode_texture`.
Result<TextureArea> decode_coverage(std::span<const std::uint8_t> file, double cutoff);

}  // namespace exitance
