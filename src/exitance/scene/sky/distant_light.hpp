#pragma once

#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/scene/sky/sky_model.hpp"

namespace exitance {

/// A distant polygon that represents a part of the distant light.
struct DistantFacet {
    std::vector<Vec3> corners;      ///< Directions, not normalized; counter-clockwise seen from inside.
    Normal n;                       ///< Unit normal, towards the scene.
    Spectrum exitance;              ///< W/m^2
    const SkyModel* sky = nullptr;  ///< Directional radiance; null: constant.
    double smooth_width = 0;        ///< Smooth width of the radiance on this facet, radians.
    bool is_dome = false;           ///< True for a part of a dome, false for a disc.
};

/// Light from infinitely far away that arrives from a range of directions: skies, the glow of the ground, the sun's
/// disc. Sky and sun are not part of the geometry and have no elements; any polygon can occlude them.
struct DistantLight {
    /// Half of all directions, above or below the horizon (SkyModel::below).
    struct Dome {
        SkyModel model;       ///< Normalized.
        Spectrum irradiance;  ///< Irradiance of an unobstructed horizontal plane that faces the dome, W/m^2 (lx).
    };
    /// Uniform radiance within half_angle (at most `widest_disc`) of a direction.
    struct Disc {
        Normal towards;         ///< Unit vector towards the centre of the disc.
        double half_angle = 0;  ///< Radians.
        Spectrum irradiance;    ///< Irradiance of a plane perpendicular to this direction, W/m^2 (lx).
    };
    std::vector<Dome> domes;
    std::vector<Disc> discs;

    bool empty() const { return domes.empty() && discs.empty(); }
    void append(const DistantLight& more);
    /// Returns pi times the radiance seen in direction w (unit vector), W/m^2; includes discs if `with_discs`.
    Spectrum radiosity(const Vec3& w, bool with_discs) const;
    bool is_sane() const;
};
constexpr double widest_disc = 75 * pi / 180;

/// Returns facets that represent the light: the subdivided faces of a cube whose centre is at every receiver point, and
/// regular polygons with the solid angles of the discs. `light` must outlive the result.
std::vector<DistantFacet> distant_facets(const DistantLight& light);

}  // namespace exitance
