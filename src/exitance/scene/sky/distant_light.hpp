#pragma once

#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/scene/sky/sky_model.hpp"

namespace exitance {

/// A far polygon that stands for a part of distant light.
struct DistantFacet {
    std::vector<Vec3> corners;      ///< Directions, not of length 1; counter-clockwise seen from within.
    Normal n;                       ///< Towards the scene.
    Spectrum exitance;              ///< W/m^2
    const SkyModel* sky = nullptr;  ///< Its radiance by direction; null: the same everywhere.
    double smooth_width = 0;        ///< Of that, radians.
    bool is_dome = false;           ///< Not of a disc.
};

/// Light from infinitely far away that comes from more than one direction: skies, the glow of the ground, the sun's
/// disc. It has no place in the scene, no elements, and everything in the scene stands before it.
struct DistantLight {
    /// Half of all directions, above or below the horizon (SkyModel::below).
    struct Dome {
        SkyModel model;       ///< Normalized.
        Spectrum irradiance;  ///< Of a horizontal plane that faces it and sees all of it, W/m^2 (lx).
    };
    /// Uniform within half_angle (at most `widest_disc`) of a direction.
    struct Disc {
        Normal towards;         ///< Of length 1.
        double half_angle = 0;  ///< Radians.
        Spectrum irradiance;    ///< Of a plane that faces it, W/m^2 (lx).
    };
    std::vector<Dome> domes;
    std::vector<Disc> discs;

    bool empty() const { return domes.empty() && discs.empty(); }
    void append(const DistantLight& more);
    /// What is seen in a direction w of length 1, times pi, W/m^2: discs too, if asked for.
    Spectrum radiosity(const Vec3& w, bool with_discs) const;
    bool is_sane() const;
};
constexpr double widest_disc = 75 * pi / 180;

/// What stands for it: a cube about the point that is lit, each face cut up, of which every point of the scene is the
/// middle; regular polygons of the discs' solid angles. `light` must outlive what is returned.
std::vector<DistantFacet> distant_facets(const DistantLight& light);

}  // namespace exitance
