#pragma once

#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// A pane of clear glass. Light passes straight through it in both directions, reduced by reflection at both faces
/// (Fresnel) and by absorption. It is not a surface and has no elements. Rays of reflected light are mirrored by it.
struct Pane {
    std::vector<Point> corners;  ///< Planar, simple polygon, metres; convex in a Scene.
    Normal n;                    ///< Unit normal, to either side.
    Spectrum transmissivity;     ///< Share of light that is not absorbed in one perpendicular passage; at most 1.
    double index = 1.52;         ///< Refractive index.
    int line = 0;                ///< Line in the scene file.

    /// Returns the share of light transmitted at this cosine (> 0) to the normal:
    ///
    ///     T = t (1 - r)^2 / (1 - r^2 t^2) for either polarisation,   t = transmissivity^(1 / cos inside),
    ///
    /// averaged over both polarisations; includes all internal reflections.
    Spectrum transmission(double cosine) const;
    /// Returns the reflected share: r + r (1 - r)^2 t^2 / (1 - r^2 t^2), averaged over both polarisations.
    Spectrum reflection(double cosine) const;
    bool is_sane() const;
};

/// Returns the transmissivity for which transmission(1) is `transmittance`, the usual specification of glass. At most
/// 1, which corresponds to a transmittance of 0.918 for an index of 1.52.
Spectrum transmissivity_of(const Spectrum& transmittance, double index = 1.52);

/// Splits panes into convex polygons and computes their normals; omits panes without area.
std::vector<Pane> convex_panes(const std::vector<Pane>& panes);

}  // namespace exitance
