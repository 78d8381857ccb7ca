#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/glare/daylight_glare_rules.hpp"
#include "exitance/measure/glare/view_triangle.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

/// The luminances that an eye sees in front of it, for daylight glare: skies, suns, lamps and lit surfaces, also
/// through panes. Light that panes mirror is not seen.
///
/// All visible parts and their solid angles are exact. Surfaces are cut into triangles of at most 0.1 rad, the sky into
/// triangles of at most 0.02 rad. The luminance of each quarter of a triangle is evaluated in its middle. Triangles
/// whose luminance varies are cut further, down to 0.0125 rad: those with more than 1e-4 of all light, and those that
/// the threshold of glare divides. Bright spots of less than 0.05 rad on a surface can be missed.
class FieldOfView {
  public:
    /// `eye`: not on a surface. All arguments must outlive this object. O(pieces + parts): about 1 s for a room.
    FieldOfView(const RadiosityFunction& light, const SurfacePoint& eye, const LightUnit& lux);

    /// Returns the mean luminance of the half of the directions in front of the eye, cd/m^2.
    double mean_luminance() const { return mean_; }
    /// Returns the illuminance of the eye's plane by light that surfaces reflect, lx.
    double reflected_illuminance() const { return reflected_; }
    /// Returns the parts with more than this luminance, cd/m^2.
    std::vector<GlarePart> brighter_than(double threshold) const;
    /// Returns the name of a part's origin: a group of faces, a light, "sky" or "sun".
    const std::string& name(std::uint32_t origin) const { return names_[origin]; }

  private:
    /// A visible triangle of a surface, with the luminances of its quarters.
    struct SurfaceTriangle {
        ViewTriangle shape;
        SurfaceId surface;
        std::array<double, 4> luminance{}, reflected{};  ///< cd/m^2: all light, and reflected light.

        bool varies(double threshold) const;  ///< True if the threshold divides the luminances.
        bool is_coarse() const;               ///< True if the triangle is large enough to be split further.
        double variation() const;             ///< Largest difference of the luminances times the solid angle, lx.
    };

    void add_surfaces();
    void add_sky();
    void add_lights();
    std::uint32_t origin_of(const std::string& name);
    void evaluate(std::vector<SurfaceTriangle>& triangles) const;
    template <class IsToCut>
    std::vector<SurfaceTriangle> refined(std::vector<SurfaceTriangle> triangles, const IsToCut& is_to_cut) const;
    void add_up();
    GlarePart part_of(const ViewTriangle& t, SurfaceId s, double luminance) const;

    const RadiosityFunction& light_;
    const SurfacePoint& eye_;
    const LightUnit& lux_;
    std::vector<std::string> names_;  ///< Groups of the scene first.
    std::vector<SurfaceTriangle> surfaces_;
    std::vector<GlarePart> apart_;  ///< Sky, suns and lights without extent.
    double mean_ = 0, reflected_ = 0;
};

}  // namespace exitance
