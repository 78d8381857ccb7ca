#pragma once

#include <array>
#include <vector>

#include "exitance/links/link_sites.hpp"

namespace exitance {

/// Transport from an element to points that may be near it, per node of the element:
///
///     K_l(x) = int over q of  cos cos / (pi |y - x|^2)  N_l(y) dA
///
/// where N_l is the function that is 1 at node l. A box of the element that appears small from x is integrated by Gauss
/// points; a larger one is subdivided; the last ones use the exact form factor of the box. Finally the row is scaled to
/// the exact form factor of the whole element, so that uniform light is transported exactly. O(log(size / distance))
/// boxes, about 10 ns per point.
class NearRow {
  public:
    explicit NearRow(const LinkSites& sites) : sites_(sites) {}
    void set_source(ElementId q);
    /// Writes nodes() entries to `out`; returns their sum, the form factor.
    double operator()(const Point& x, const Normal& n, double* out);

  private:
    struct Box {
        /// Origin and size in the element's coordinates. A negative size denotes an inverted triangle.
        Vec2 origin, size;
    };
    void add(const Point& x, const Normal& n, const Box& box, int depth);
    void add_point(Vec2 uv, double K);

    const LinkSites& sites_;
    Patch frame_;
    Normal normal_;
    std::vector<Point> outline_;
    std::array<Point, 4> corners_;
    std::array<double, 9> sum_{};
};

}  // namespace exitance
