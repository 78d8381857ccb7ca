#pragma once

#include <cmath>

#include "exitance/scene/sky/directional_picture.hpp"

namespace exitance {

/// The directions of the pixels of a picture.
class PicturePixels {
  public:
    PicturePixels(const DirectionalPicture& picture, double rotation)
        : width_(static_cast<double>(picture.width)),
          height_(static_cast<double>(picture.height)),
          turned_(rotation / 360) {}

    /// Returns the sine of the altitude of the border above a row; `row` = height: the nadir.
    double upper_sine(std::size_t row) const { return std::cos(pi * static_cast<double>(row) / height_); }
    /// Returns the azimuth of the left border of a column, in turns counter-clockwise from +x; may be outside [0, 1).
    double left_turn(std::size_t column) const { return 0.5 - static_cast<double>(column) / width_ + turned_; }
    /// Returns the solid angle of a pixel, sr.
    double solid_angle(std::size_t row) const { return 2 * pi / width_ * (upper_sine(row) - upper_sine(row + 1)); }
    /// Returns the integral of the direction over a pixel, sr.
    Vec3 moment(std::size_t row, std::size_t column) const {
        const double top = 0.5 * pi - pi * static_cast<double>(row) / height_, bottom = top - pi / height_;
        // Integrals of cos^2 and of sin cos of the altitude.
        const double flat = 0.5 * (top - bottom) + 0.25 * (std::sin(2 * top) - std::sin(2 * bottom));
        const double upright = 0.5 * (std::pow(std::sin(top), 2) - std::pow(std::sin(bottom), 2));
        const double left = 2 * pi * left_turn(column), right = left - 2 * pi / width_;
        return {flat * (std::sin(left) - std::sin(right)), flat * (std::cos(right) - std::cos(left)),
                upright * 2 * pi / width_};
    }

  private:
    double width_, height_, turned_;
};

}  // namespace exitance
