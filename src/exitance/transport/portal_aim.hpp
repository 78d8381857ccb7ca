#pragma once

#include <array>
#include <span>

#include "exitance/transport/light_portals.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Rays of a place that are aimed at openings into lighter rooms. Where a dark room is lit through a small hole, one
/// ray in thousands would find it. The hemisphere is cut in two: what lies towards some parallelograms, and the rest,
///
///     E = int_rest b cos / pi dw + int_towards b cos / pi dw.
///
/// Half of the rays have density cos / pi and count where they are in the rest; the others have density
/// sum_c q_c r_c^2 / (A_c cos_c), points uniform on parallelogram c taken with chance q_c. Unbiased, whether or not the
/// parallelograms cover the openings, and whatever stands between.
class PortalAim {
  public:
    /// The parallelograms that rays of a place are to be aimed at; none where that is not worth it.
    static std::span<const PortalCell> candidates(const Stage& stage, RegionId own, const Point& x, const Normal& n);

    /// Aims from x, off the parallelograms that are near or behind it. n is the normal there.
    void set(std::span<const PortalCell> cells, const Point& x, const Normal& n);

    /// Is a direction one towards a parallelogram, so that rays that are not aimed do not count there?
    bool is_aimed_at(const Vec3& direction) const;

    struct Ray {
        Vec3 direction;
        double weight = 0;  ///< Of what it meets in E: cos / pi by its density.
    };
    /// An aimed ray by two numbers in [0, 1); of weight 0 where nothing is aimed at.
    Ray aimed(double a, double b) const;

    /// As how many rays each of both halves counts.
    static constexpr double share = 2;

  private:
    struct Target {
        const PortalCell* cell = nullptr;
        double chance = 0;
        double height = 0;  ///< Of x over its plane, metres.
        Vec3 offset;        ///< From x to its corner.
    };
    static constexpr std::size_t most_targets = 16;

    double density(const Vec3& direction) const;

    std::array<Target, most_targets> targets_;
    std::size_t count_ = 0;
    Normal n_;
};

}  // namespace exitance
