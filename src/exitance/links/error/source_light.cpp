#include "exitance/links/error/source_light.hpp"

namespace exitance {
namespace {

/// cos cos / r^2 between two points of two surfaces, m^-2; 0 if either faces away from the other.
double point_kernel(const Point& x, const Normal& n, const Point& y, const Normal& m) {
    const Vec3 d = y - x;
    const double here = dot(n, d), there = -dot(m, d), rr = squared_norm(d);
    return here > 0 && there > 0 ? here * there / (rr * rr) : 0;
}

}  // namespace

NodeRow SourceLight::kernel_row(const Point& x, const Normal& n) const {
    NodeRow out{};
    for (std::size_t l = 0; l < nodes; ++l) out[l] = weight[l] * area_over_pi * point_kernel(x, n, node[l], normal);
    return out;
}

double SourceLight::kernel_from(const Point& y, const Point& x, const Normal& n) const {
    return area_over_pi * point_kernel(x, n, y, normal);
}

SourceLight source_light(const LinkSites& sites, const NodalField& b, double roughness, ElementId element,
                         const Spectrum& w) {
    SourceLight out;
    out.element = element, out.normal = sites.normal(element), out.nodes = sites.nodes();
    out.area_over_pi = sites.tree().area(element) / pi;
    out.roughness = mean(w) * roughness;
    const Patch frame = sites.frame(element);
    for (std::size_t l = 0; l < out.nodes; ++l) {
        out.node[l] = sites.node(frame, l);
        out.weight[l] = sites.weight(element, l);
        out.light[l] = mean(w * b.node(element, l));
        out.mean += out.weight[l] * out.light[l];
    }
    return out;
}

}  // namespace exitance
