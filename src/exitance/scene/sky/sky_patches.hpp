#pragma once

#include <vector>

#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

/// The sky in patches: Tregenza's 145, or Reinhart's division of each into m x m (577 for m = 2, 2305 for m = 4), rows
/// of equal height from the horizon up, counted clockwise from y; patch 0 is the ground.
class SkyPatches {
  public:
    explicit SkyPatches(int m);

    std::size_t size() const { return middle_.size(); }  ///< With the ground.
    /// The patch in a direction of length 1.
    std::size_t of(const Vec3& w) const;
    const Normal& middle(std::size_t patch) const { return middle_[patch]; }
    double solid_angle(std::size_t patch) const { return solid_angle_[patch]; }  ///< sr

    /// Irradiance of the ground by a patch of radiance 1, above the horizon.
    double horizontal(std::size_t patch) const { return horizontal_[patch]; }

    /// Facets of exitance pi, radiance 1, and which patch each belongs to. They leave nothing open between them.
    const std::vector<DistantFacet>& facets() const { return facets_; }
    const std::vector<std::uint32_t>& patch_of_facet() const { return patch_of_facet_; }

    /// Mean of value() over each patch above the ground, by 3 x 3 places; 0 for the ground.
    std::vector<double> mean_values(const SkyModel& sky) const;

  private:
    void make_facets();
    double altitude(std::size_t row) const { return static_cast<double>(row) * height_; }  ///< Of a row's lower border.

    double height_;                    ///< Of a row, radians.
    std::vector<std::size_t> first_;   ///< Of every row, its first patch; at the end the zenith's.
    std::vector<std::size_t> in_row_;  ///< Patches of a row.
    std::vector<Normal> middle_;
    std::vector<double> solid_angle_, horizontal_;
    std::vector<DistantFacet> facets_;
    std::vector<std::uint32_t> patch_of_facet_;
};

}  // namespace exitance
