#pragma once

#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// A pane of clear glass: light goes straight through it, from either side, less what its faces reflect (Fresnel) and
/// what it absorbs on the way. It is no surface and has no elements; rays of reflected light are mirrored by it.
struct Pane {
    std::vector<Point> corners;  ///< Of a planar, simple polygon, metres; in a Scene convex.
    Normal n;                    ///< Of length 1, to either side.
    Spectrum transmissivity;     ///< Share of light that passes the inside once, straight on; at most 1.
    double index = 1.52;         ///< Of refraction.
    int line = 0;                ///< Where it stands in the scene file.

    /// Share of the light that passes under this cosine to the normal, above 0:
    ///
    ///     T = t (1 - r)^2 / (1 - r^2 t^2) for either polarisation,   t = transmissivity^(1 / cos inside),
    ///
    /// the mean of both, all reflections between the faces counted.
    Spectrum transmission(double cosine) const;
    /// Share of the light that it mirrors: r + r (1 - r)^2 t^2 / (1 - r^2 t^2), the mean of both polarisations.
    Spectrum reflection(double cosine) const;
    bool is_sane() const;
};

/// The transmissivity of which transmission(1) is `transmittance`, as most of what is known of glass is given; at most
/// 1, which clear glass with an index of 1.52 comes to at 0.918.
Spectrum transmissivity_of(const Spectrum& transmittance, double index = 1.52);

/// Panes cut to convex polygons, with their normals; those without area left out.
std::vector<Pane> convex_panes(const std::vector<Pane>& panes);

}  // namespace exitance
