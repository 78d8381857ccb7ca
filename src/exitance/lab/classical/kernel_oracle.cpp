#include "exitance/lab/classical/kernel_oracle.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// Kernel cos cos / (pi r^2); 0 from behind.
double point_kernel(const Point& x, const Normal& n, const Point& y, const Normal& m) {
    const Vec3 d = y - x;
    const double up = dot(n, d), down = -dot(m, d), squared = dot(d, d);
    return up > 0 && down > 0 ? up * down / (pi * squared * squared) : 0;
}

}  // namespace

KernelOracle::KernelOracle(const NodalBasis& basis)
    : basis_(basis), square_(between(Patch::Shape::parallelogram)), triangle_(between(Patch::Shape::triangle)) {}

KernelOracle::Between KernelOracle::between(Patch::Shape shape) const {
    // Triangle rules of 1, 3, 6, 7 points are exact to degree 1, 2, 4, 5: the next one follows the rule of the basis.
    constexpr std::array<int, 3> next_degree = {2, 4, 5};
    const int order = basis_.order();
    const auto rule = shape == Patch::Shape::triangle ? triangle_rule(next_degree[static_cast<std::size_t>(order - 1)])
                                                      : square_rule(order + 1);
    Between out{rule, {}};
    const std::size_t n = basis_.count();
    for (const PlanarNode& node : rule) {
        out.factors.resize(out.factors.size() + n);
        basis_.interpolate(shape, node.at, std::span(out.factors).last(n));
    }
    return out;
}

KernelOracle::Misfit KernelOracle::misfit(const Patch& receiver, const Patch& source) const {
    const Normal n = receiver.normal(), m = source.normal();
    const auto receiving = basis_.nodes(receiver.shape), sending = basis_.nodes(source.shape);
    const Between &to = of(receiver.shape), &from = of(source.shape);
    const std::size_t count = basis_.count();
    Misfit out;
    std::vector<double> at_nodes(count * count), rows(to.points.size() * count);
    for (std::size_t k = 0; k < count; ++k)
        for (std::size_t l = 0; l < count; ++l) {
            const double weight = receiving[k].weight * sending[l].weight;
            if (!(weight > 0)) continue;  // nodes unused on triangles
            const double g = point_kernel(receiver.at(receiving[k].at), n, source.at(sending[l].at), m);
            at_nodes[k * count + l] = g, out.mean += weight * g;
        }
    for (std::size_t i = 0; i < to.points.size(); ++i)
        for (std::size_t k = 0; k < count; ++k)
            for (std::size_t l = 0; l < count; ++l)
                rows[i * count + l] += to.factors[i * count + k] * at_nodes[k * count + l];
    for (std::size_t i = 0; i < to.points.size(); ++i)
        for (std::size_t j = 0; j < from.points.size(); ++j) {
            double interpolated = 0;
            for (std::size_t l = 0; l < count; ++l) interpolated += from.factors[j * count + l] * rows[i * count + l];
            const double g = point_kernel(receiver.at(to.points[i].at), n, source.at(from.points[j].at), m);
            out.difference += to.points[i].weight * from.points[j].weight * std::abs(g - interpolated);
        }
    return out;
}

double KernelOracle::strength(const Patch& receiver, const Patch& source, double visible_share) const {
    const Misfit found = misfit(receiver, source);
    const double by_visibility = std::sqrt(std::max(0.0, visible_share * (1 - visible_share))) * found.mean;
    return receiver.area() * source.area() * std::hypot(found.difference, by_visibility);
}

}  // namespace exitance
