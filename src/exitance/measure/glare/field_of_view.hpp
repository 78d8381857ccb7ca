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
/// The visible part of every polygon and of the sky is exact, so that all solid angles are. It is cut into triangles of
/// at most 0.1 rad, of which the luminance of each quarter is evaluated in its middle. Triangles that the threshold of
/// glare divides are cut further, down to 0.0125 rad: bright spots of less than 0.05 rad on a surface can be missed.
class FieldOfView {
  public:
    /// `eye`: not on a surface. All must outlive this. O(pieces + parts): about 1 s for a room.
    FieldOfView(const RadiosityFunction& light, const Receiver& eye, const LightUnit& lux);

    /// Returns the mean luminance of the half of the directions in front of the eye, cd/m^2.
    double mean_luminance() const { return mean_; }
    /// Returns the parts with more than this luminance, cd/m^2.
    std::vector<GlarePart> brighter_than(double threshold) const;
    /// Returns the name of a part's origin: a group of faces, a light, "sky" or "sun".
    const std::string& name(std::uint32_t origin) const { return names_[origin]; }

  private:
    /// A visible triangle of a surface, with the luminances of its quarters.
    struct SurfaceTriangle {
        ViewTriangle shape;
        SurfaceId surface;
        std::array<double, 4> luminance{};
    };

    void add_surfaces();
    void add_sky();
    void add_lights();
    std::uint32_t origin_of(const std::string& name);
    double luminance_of(SurfaceId s, const Light& there, const Point& y) const;
    void evaluate(std::vector<SurfaceTriangle>& triangles) const;
    GlarePart part_of(const ViewTriangle& t, SurfaceId s, double luminance) const;

    const RadiosityFunction& light_;
    const Receiver& eye_;
    const LightUnit& lux_;
    std::vector<std::string> names_;  ///< Groups of the scene first.
    std::vector<SurfaceTriangle> surfaces_;
    std::vector<GlarePart> apart_;  ///< Sky, suns and lights without extent.
    double mean_ = 0;
};

}  // namespace exitance
