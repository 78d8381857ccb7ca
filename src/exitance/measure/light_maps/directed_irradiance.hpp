#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/measure/light_maps/light_map.hpp"
#include "exitance/measure/probes/harmonics.hpp"

namespace exitance {

/// Irradiance at a place as a linear function of the normal m of a plane there, W/m^2:
///
///     E(m) = constant + slope . m
///
/// This is the irradiance of a radiance with harmonics of degrees 0 and 1 only. Mean values of several places are means
/// of their terms.
struct DirectedIrradiance {
    Spectrum constant = {};              ///< W/m^2
    std::array<Spectrum, 3> slope = {};  ///< Along the axes x, y, z, W/m^2.

    Spectrum at(const Normal& m) const;
    DirectedIrradiance& operator+=(const DirectedIrradiance& o);
    DirectedIrradiance& operator*=(double factor);
};

/// Number of tilted normals from which the linear function follows.
constexpr std::size_t tilted_count = 4;

/// Returns a normal tilted by 45 degrees, towards the frame's directions u, -u, v, -v.
Normal tilted(const Frame& frame, std::size_t k);

/// Returns the linear function that equals `own` at the normal and fits the irradiances of the tilted normals best, by
/// least squares. Exact for light from directions within 45 degrees of the normal, and for uniform light.
DirectedIrradiance fit_irradiance(const Frame& frame, const Spectrum& own,
                                  const std::array<Spectrum, tilted_count>& at_tilted);

/// Scales the function so that it equals the irradiance at n, in every band. A scale above 2 would magnify what few
/// points have seen by chance: the rest is added as uniform light.
void constrain(DirectedIrradiance& light, const Normal& n, const Spectrum& irradiance);

/// Replaces the function by one whose slopes have one direction in all bands, that of the light's vector: its component
/// along n is the irradiance. The value at n stays; values at the tilted normals are fitted by least squares.
void align_to_dominant(DirectedIrradiance& light, const Normal& n);

/// Returns the function at a texel of a map that has them.
DirectedIrradiance directed_at(const LightMap& map, std::size_t texel);
void store_directed(const DirectedIrradiance& light, std::size_t texel, LightMap& map);

/// Sets the function of an extrapolated texel: the mean of others', scaled to the texel's irradiance. Does nothing in
/// maps without directions.
void continue_directed(std::span<const std::size_t> others, const Spectrum& irradiance, std::size_t texel,
                       LightMap& map);

/// Returns coefficients of radiance, W/(m^2 sr), in the order (0, 0), (1, -1), (1, 0), (1, 1), see harmonics_at. The
/// irradiance by `irradiance_factors` is that of the function.
std::array<Spectrum, 4> radiance_of(const DirectedIrradiance& light);

/// The form of one direction, from the mean over bands.
struct DominantDirection {
    Normal direction;  ///< Towards most light; z if there is none.
    /// Share of the light that has the direction, 0 to 1: E(m) is proportional to 1 - share + share direction . m.
    double share = 0;
};
DominantDirection dominant_direction(const DirectedIrradiance& light);

}  // namespace exitance
