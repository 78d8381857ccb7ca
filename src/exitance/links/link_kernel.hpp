#pragma once

#include "exitance/base/four.hpp"
#include "exitance/base/limits.hpp"
#include "exitance/links/link_sites.hpp"

namespace exitance {

/// The kernel between a point and the nodes of a source, four nodes at a time:
///
///     w_l A max(0, n . d) max(0, -m . d) / (pi |d|^4),    d = y_l - x
///
/// where n is the normal at x and m that of the source. Lanes beyond the last node are 0.
template <std::size_t groups>
class SourceNodes {
  public:
    SourceNodes(const LinkSites& sites, ElementId source) : normal_(sites.normal(source)) {
        const Patch frame = sites.frame(source);
        const double area = sites.tree().area(source) / pi;
        const auto nodes = sites.basis().nodes(sites.tree().patch(source).shape);
        for (std::size_t g = 0; g < groups; ++g) {
            for (std::size_t lane = 0; lane < four::lanes; ++lane) {
                const std::size_t l = 4 * g + lane;
                const Point y = l < nodes.size() ? sites.node(frame, l) : frame.centre();
                at_[g].x[lane] = y.x, at_[g].y[lane] = y.y, at_[g].z[lane] = y.z;
                weight_[g][lane] = l < nodes.size() ? area * nodes[l].weight : 0;
            }
        }
    }

    void kernel(const Point& x, const Normal& n, four::Real (&out)[groups]) const {
        const four::Vec from{four::Real{} + x.x, four::Real{} + x.y, four::Real{} + x.z};
        for (std::size_t g = 0; g < groups; ++g) {
            const four::Vec d = at_[g] - from;
            const four::Real zero{}, rr = four::dot(d, d) + min_divisor;
            const four::Real cosines = four::max(four::dot(n, d), zero) * four::max(-four::dot(normal_, d), zero);
            out[g] = weight_[g] * cosines / (rr * rr);
        }
    }

  private:
    Normal normal_;
    four::Vec at_[groups];
    four::Real weight_[groups];
};

inline double sum(const four::Real& v) {
    return (v[0] + v[1]) + (v[2] + v[3]);
}

}  // namespace exitance
