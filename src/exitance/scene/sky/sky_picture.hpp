#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Radiance of one band in all directions, from a picture: a table over altitude and azimuth. Values are at the middles
/// of the cells and linear between them. There is no interpolation across the horizon, where two domes meet.
class SkyPicture {
  public:
    static constexpr std::size_t rows = 64, columns = 128;  ///< Numbers of cells; a cell is 2.8 degrees high.
    static constexpr std::size_t size = rows * columns;
    static constexpr double cell_angle = pi / rows;  ///< Height of a cell, radians.

    /// `values` has `size` entries, row by row from straight down to the zenith; column 0 begins at +x, and columns are
    /// counter-clockwise seen from above.
    explicit SkyPicture(std::vector<double> values);

    /// Returns the radiance in direction w, a unit vector, of the dome on the side `is_below` of the horizon.
    double value(const Vec3& w, bool is_below) const;
    /// Returns the cosine-weighted mean over the half above or below the horizon. Relative error 1e-4.
    double horizontal_mean(bool is_below) const;
    std::span<const double> values() const { return values_; }
    /// True if the values are finite and not negative.
    static bool are_sane(std::span<const double> values);

  private:
    std::vector<double> values_;
};

}  // namespace exitance
