#pragma once

#include <array>
#include <vector>

#include "exitance/links/link_sites.hpp"

namespace exitance {

/// Light from an element to points that may be near to it, node by node of the element:
///
///     K_l(x) = int over q of  cos cos / (pi |y - x|^2)  N_l(y) dA
///
/// with N_l the function that is 1 at node l: boxes that are small from x take Gauss's points, larger ones are cut,
/// and the last ones take the exact form factor of the box. In the end all are scaled to the exact form factor of the
/// whole element, so that even light arrives exactly. O(log(size / distance)) boxes, about 10 ns a point.
class NearRow {
  public:
    explicit NearRow(const LinkSites& sites) : sites_(sites) {}
    void set_source(ElementId q);
    /// Writes nodes() entries; returns their sum, the form factor.
    double operator()(const Point& x, const Normal& n, double* out);

  private:
    struct Box {
        Vec2 origin, size;  ///< In the element's coordinates; a triangle's box of negative size is a turned one.
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
