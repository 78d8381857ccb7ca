#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Intensity of a luminaire in two vertical planes, one value per degree from -180 to 180, measured from straight down.
/// Positive angles are towards C0 (or C90), negative ones towards C180 (or C270).
struct IntensityCurves {
    static constexpr int last = 180;                   ///< Largest angle, degrees.
    static constexpr std::size_t size = 2 * last + 1;  ///< Number of values of a curve.
    std::vector<double> c0, c90;                       ///< cd, or cd per 1000 lm of the lamps.
    bool is_per_kilolumen = false;
};

/// Facts of a photometric file, for schedules of luminaires. The light itself is in materials and emission profiles.
struct LuminaireType {
    std::string name;  ///< Manufacturer and product as given in the file; otherwise the name of the file.
    std::string file;  ///< Name of the file, without folders.
    double flux = 0;   ///< Flux of the luminaire, lm.
    double watts = 0;  ///< Connected power, W; 0: unknown.
    IntensityCurves curves;
};

/// One luminaire of a scene.
struct InstalledLuminaire {
    std::uint32_t type = 0;   ///< Index of the luminaire's type.
    std::uint32_t group = 0;  ///< Index of the group of its faces.
    Point position;           ///< Centre of the luminaire's opening, metres.
    double flux = 0;          ///< Flux of the new luminaire at full output, lm.
    double maintenance = 1;   ///< Maintenance factor by which its light has been reduced already.
};

}  // namespace exitance
