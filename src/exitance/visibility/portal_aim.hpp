#pragma once

#include <array>
#include <span>

#include "exitance/visibility/portal_cells.hpp"

namespace exitance {

/// Aims rays from a point at openings into brighter rooms, or to the sky. If a dark room is lit through a small hole,
/// only one unaimed ray in thousands would find it. The hemisphere is divided into the directions towards some
/// parallelograms and the rest:
///
///     E = int_rest b cos / pi dw + int_towards b cos / pi dw.
///
/// Half of the rays have density cos / pi and count only in the rest. The others have density sum_c q_c r_c^2 / (A_c
/// cos_c): uniform points on parallelogram c, which is chosen with probability q_c. Unbiased, even if the
/// parallelograms cover the openings incompletely or are occluded.
class PortalAim {
  public:
    /// Maximum number of parallelograms at which rays of a place are aimed.
    static constexpr std::size_t max_targets = 32;

    /// True if part of a parallelogram is above the plane of x, and it is farther away than it is long.
    static bool can_be_aimed_at(const PortalCell& cell, const Point& x, const Normal& n);

    /// Returns the share of rays of density cos / pi about n that lead to a parallelogram; 0 if it is behind x, or too
    /// near to be aimed at.
    static double form_factor(const PortalCell& cell, const Point& x, const Normal& n);

    /// Prepares aiming from x with normal n. Skips parallelograms that are too near or behind x.
    void set(std::span<const PortalCell> cells, const Point& x, const Normal& n);

    /// True if a direction leads to a parallelogram, so that unaimed rays in that direction must not count.
    bool is_aimed_at(const Vec3& direction) const;

    struct Ray {
        Vec3 direction;
        double weight = 0;  ///< Factor on the radiosity it hits, for its contribution to E: cos / pi over its density.
    };
    /// Returns an aimed ray for two numbers in [0, 1). Its weight is 0 if there are no targets.
    Ray aimed(double a, double b) const;

    /// Weight of each ray, as each half has only half of the rays.
    static constexpr double share = 2;

  private:
    struct Target {
        const PortalCell* cell = nullptr;
        double chance = 0;  ///< Probability of being chosen.
        double height = 0;  ///< Height of x over the parallelogram's plane, metres; negative behind it.
        Vec3 offset;        ///< Vector from x to the parallelogram's corner.
    };
    double density(const Vec3& direction) const;

    std::array<Target, max_targets> targets_;
    std::size_t count_ = 0;
    Normal n_;
};

}  // namespace exitance
