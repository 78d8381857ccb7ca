#pragma once

#include <vector>

#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

/// Subdivision of the sky into patches: Tregenza's 145, or Reinhart's division of each into m x m (577 for m = 2, 2305
/// for m = 4). Rows of equal height from the horizon up, patches clockwise from y; patch 0 is the ground.
class SkyPatches {
  public:
    explicit SkyPatches(int m);

    /// Number of patches of a division, with the ground.
    static constexpr std::size_t count(std::size_t m) { return 144 * m * m + 2; }
    std::size_t size() const { return middle_.size(); }  ///< Number of patches, including the ground.
    /// Returns the patch that contains a direction (unit vector).
    std::size_t of(const Vec3& w) const;
    const Normal& middle(std::size_t patch) const { return middle_[patch]; }
    double solid_angle(std::size_t patch) const { return solid_angle_[patch]; }  ///< sr

    /// Returns the irradiance of the ground by a patch above the horizon with radiance 1.
    double horizontal(std::size_t patch) const { return horizontal_[patch]; }

    /// Returns facets of exitance pi (radiance 1), and the patch of each. They cover all directions without gaps.
    const std::vector<DistantFacet>& facets() const { return facets_; }
    const std::vector<std::uint32_t>& patch_of_facet() const { return patch_of_facet_; }

    /// Returns the mean of value() over each patch above the ground, by 3 x 3 points; 0 for the ground. About 20 ns per
    /// point.
    std::vector<double> mean_values(const SkyModel& sky) const;

  private:
    void make_facets();
    void make_points();
    /// Altitude of the lower border of a row, radians.
    double altitude(std::size_t row) const { return static_cast<double>(row) * height_; }

    double height_;                    ///< Height of a row, radians.
    std::vector<std::size_t> first_;   ///< First patch of every row; the last entry is the zenith's.
    std::vector<std::size_t> in_row_;  ///< Number of patches per row.
    std::vector<Normal> middle_;
    std::vector<double> solid_angle_, horizontal_;
    static constexpr int points_across = 3;  ///< Points per patch in each direction for mean_values().
    std::vector<Normal> points_;             ///< Points of all patches but the ground and the zenith, patch by patch.
    std::vector<DistantFacet> facets_;
    std::vector<std::uint32_t> patch_of_facet_;
};

}  // namespace exitance
