#include "exitance/discontinuity/misfit.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/discontinuity/findable.hpp"

namespace exitance {

Misfit misfit(const BisectionMesh& mesh, std::uint32_t triangle, std::span<const Spectrum> values,
              const Spectrum& weight) {
    const BisectionMesh::Triangle& t = mesh.triangles()[triangle];
    Misfit out;
    double square = 0;
    const auto look = [&](const Spectrum& error, double part) {
        square += part * squared(weight * error) / static_cast<double>(bands);
        out.largest = std::max(out.largest, std::abs(mean(weight * error)));
    };
    // Mean squares, over a triangle, of the polynomials that vanish at the six nodes of the quadratic interpolant and
    // are 1 at a test node. Derived from the mean of a^i b^j c^k over a triangle, 2 i! j! k! / (i + j + k + 2)!, for
    // barycentric coordinates a, b, c. On an edge, the cubic 32/3 a b (a - b) is 1 at one test node and -1 at the
    // other; its mean square is 128/945 = 0.1354, half of which counts for each of the two. At the inner node, the
    // bubble is 27 a b c times 32/27; 729/2520 = 0.2893, and 0.2893 (32/27)^2 = 128/315.
    constexpr double of_edge = 0.1354 / 2, of_bubble = 0.2893 * (32.0 / 27) * (32.0 / 27);
    for (std::size_t i = 0; i < 3; ++i) {
        const Spectrum &a = values[t.corner[i]], &b = values[t.corner[(i + 1) % 3]], &m = values[t.middle[i]];
        // Weights derived from the quadratic interpolant a quarter of the way from a.
        const Spectrum near_a = 0.375 * a + 0.75 * m - 0.125 * b;
        // Weights derived from the quadratic interpolant a quarter of the way from b.
        const Spectrum near_b = 0.375 * b + 0.75 * m - 0.125 * a;
        look(values[t.quarter[i][0]] - near_a, of_edge), look(values[t.quarter[i][1]] - near_b, of_edge);
    }
    const std::size_t i = t.longest, j = (i + 1) % 3, k = (i + 2) % 3;
    // Quadratic interpolant at the inner node, whose barycentric coordinates are 1/4, 1/4 (ends of the longest edge)
    // and 1/2 (opposite corner); weights derived from it.
    const Spectrum inner = -0.125 * (values[t.corner[i]] + values[t.corner[j]]) + 0.25 * values[t.middle[i]] +
                           0.5 * (values[t.middle[j]] + values[t.middle[k]]);
    look(values[t.inner] - inner, of_bubble);
    out.squared = mesh.area(triangle) * square;
    return out;
}

double bend(const BisectionMesh& mesh, std::uint32_t triangle, std::span<const Spectrum> values,
            const Spectrum& weight) {
    const BisectionMesh::Triangle& t = mesh.triangles()[triangle];
    double out = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Spectrum linear = 0.5 * (values[t.corner[i]] + values[t.corner[(i + 1) % 3]]);
        const Spectrum off = weight * (values[t.middle[i]] - linear);
        for (const double v : off.value) out = std::max(out, std::abs(v));
    }
    return out;
}

bool is_flat(double bend, double area, std::size_t triangles, const MisfitLimits& limits) {
    return area <= limits.tried_area && 2 * bend < limits.largest &&
           4 * area * bend * bend * static_cast<double>(triangles) < limits.squared;
}

std::vector<std::uint32_t> coarse_triangles(const BisectionMesh& mesh, std::span<const Misfit> misfits,
                                            const MisfitLimits& limits) {
    double sum = 0;
    for (const Misfit& m : misfits) sum += m.squared;
    const double share = sum <= limits.squared ? HUGE_VAL
                                               : limits.squared / static_cast<double>(misfits.size()) *
                                                     std::min(1.0, 2 * std::sqrt(limits.squared / sum));
    std::vector<double> missing(misfits.size());
    for (std::uint32_t t = 0; t < misfits.size(); ++t)
        if (misfits[t].largest > limits.largest) missing[t] = mesh.area(t);
    const double least = min_findable(missing, limits.unfindable_area);
    std::vector<std::uint32_t> coarse;
    for (std::uint32_t t = 0; t < misfits.size(); ++t)
        if ((misfits[t].squared > share || missing[t] > least) && mesh.longest_edge(t) > limits.shortest_edge)
            coarse.push_back(t);
    return coarse;
}

std::vector<std::uint32_t> TriedTriangles::forget_changed(BisectionMesh& mesh) {
    is_tried_.resize(mesh.triangles().size(), 0), misfits_.resize(mesh.triangles().size());
    std::vector<std::uint32_t> nodes;
    for (const std::uint32_t t : mesh.take_changed()) {
        const BisectionMesh::Triangle& now = mesh.triangles()[t];
        nodes.insert(nodes.end(), now.corner.begin(), now.corner.end());
        nodes.insert(nodes.end(), now.middle.begin(), now.middle.end());
        is_tried_[t] = 0, misfits_[t] = {};
    }
    return nodes;
}

std::vector<std::uint32_t> TriedTriangles::untried(const BisectionMesh& mesh, std::span<const Spectrum> values,
                                                   const std::function<Spectrum(std::uint32_t)>& weight,
                                                   const MisfitLimits& limits) const {
    const std::size_t count = misfits_.size();
    std::vector<std::uint8_t> is_next(count);
    parallel_for(count, 256, [&](std::size_t i) {
        const auto t = static_cast<std::uint32_t>(i);
        is_next[t] = !is_tried_[t] && !is_flat(bend(mesh, t, values, weight(t)), mesh.area(t), count, limits);
    });
    std::vector<std::uint32_t> out;
    for (std::uint32_t t = 0; t < count; ++t)
        if (is_next[t]) out.push_back(t);
    return out;
}

std::vector<std::uint32_t> TriedTriangles::places(const BisectionMesh& mesh, std::span<const std::uint32_t> triangles) {
    std::vector<std::uint32_t> nodes;
    for (const std::uint32_t t : triangles) {
        nodes.push_back(mesh.triangles()[t].inner);
        for (const auto& q : mesh.triangles()[t].quarter) nodes.insert(nodes.end(), q.begin(), q.end());
    }
    return nodes;
}

}  // namespace exitance
