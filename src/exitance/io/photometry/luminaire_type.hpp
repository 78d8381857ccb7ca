#pragma once

#include "exitance/io/photometry/photometry.hpp"
#include "exitance/scene/luminaire.hpp"

namespace exitance {

/// Intensities in the planes C0-C180 and C90-C270: cd per 1000 lm of the lamps, or cd if their flux is unknown.
IntensityCurves intensity_curves(const Photometry& photometry);

/// Facts of a luminaire for schedules. Its name is the manufacturer and the product by the keywords of the file
/// (company and luminaire, or MANUFAC and LUMINAIRE, else LUMCAT).
LuminaireType luminaire_type_of(const Photometry& photometry);

}  // namespace exitance
