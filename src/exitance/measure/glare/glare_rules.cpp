#include "exitance/measure/glare/glare_rules.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

constexpr double largest_aside = 3;                  ///< T / R; last row of Guth's table.
constexpr double largest_nadir_angle = 85 * degree;  ///< Angle from a luminaire's nadir.

/// Largest H / R in Guth's table of position indices for a given T / R. Rows are 0.1 apart: the table is empty beyond
/// 1.7 up to T / R = 0.3 and beyond 1.8 from 0.4 to 0.8, and ends at 1.9. A place between two rows must have an entry
/// in both. Source: [CIE117], table 4.1.
double end_of_guth_table(double aside) {
    return aside < 0.4 ? 1.7 : aside < 0.9 ? 1.8 : 1.9;
}

}  // namespace

SightOffsets sight_offsets(const Normal& view, const Vec3& d) {
    const bool is_upright = std::abs(view.z) > 0.999999;
    const Normal right = normalized(cross(view, is_upright ? Vec3{0, 1, 0} : Vec3{0, 0, 1}));
    return {dot(d, view), std::abs(dot(d, right)), dot(d, cross(right, view))};
}

double guth_position(const Normal& view, const Vec3& d) {
    const auto [ahead, aside, above] = sight_offsets(view, d);
    const double off = std::hypot(aside, above);
    if (above < 0) {
        const double r = off / std::max(ahead, 1e-9 * off);
        return 1 + (r < 0.6 ? 0.8 : 1.2) * r;
    }
    const double sigma = std::atan2(off, ahead) / degree, tau = std::atan2(aside, above) / degree;
    return std::exp((35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9)) * 1e-3 * sigma +
                    (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma);
}

GlareLimit glare_limit(const Normal& view, const Vec3& d, bool hangs_above) {
    const auto [ahead, aside, above] = sight_offsets(view, d);
    if (aside > largest_aside * ahead) return GlareLimit::aside;
    if (above > end_of_guth_table(aside / ahead) * ahead) return GlareLimit::overhead;
    // -d is the direction from the luminaire to the eye.
    if (hangs_above && std::hypot(d.x, d.y) > std::tan(largest_nadir_angle) * d.z) return GlareLimit::level;
    return GlareLimit::none;
}

const char* name_of(GlareLimit limit) {
    switch (limit) {
        case GlareLimit::none:
            return "counts";
        case GlareLimit::aside:
            return "aside: T/R is above 3";
        case GlareLimit::overhead:
            return "overhead: H/R is beyond Guth's table";
        case GlareLimit::level:
            return "level: it is seen from above 85 degrees from the nadir";
    }
    return "";
}

}  // namespace exitance
