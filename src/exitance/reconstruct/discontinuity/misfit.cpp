#include "exitance/reconstruct/discontinuity/misfit.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/reconstruct/discontinuity/findable.hpp"

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
    // Given by the integrals of the squares of the functions of one node over a triangle, of its area.
    constexpr double of_edge = 0.1354 / 2, of_bubble = 0.2893 * (32.0 / 27) * (32.0 / 27);
    for (std::size_t i = 0; i < 3; ++i) {
        const Spectrum &a = values[t.corner[i]], &b = values[t.corner[(i + 1) % 3]], &m = values[t.middle[i]];
        // Given by quadratic interpolation a quarter of the way from each end.
        const Spectrum near_a = 0.375 * a + 0.75 * m - 0.125 * b;
        // Given by it, too.
        const Spectrum near_b = 0.375 * b + 0.75 * m - 0.125 * a;
        look(values[t.quarter[i][0]] - near_a, of_edge), look(values[t.quarter[i][1]] - near_b, of_edge);
    }
    const std::size_t i = t.longest, j = (i + 1) % 3, k = (i + 2) % 3;
    // Given by the weights of six nodes at the coordinates 1/4, 1/4 of the longest edge's ends and 1/2 of the corner
    // across.
    const Spectrum inner = -0.125 * (values[t.corner[i]] + values[t.corner[j]]) + 0.25 * values[t.middle[i]] +
                           0.5 * (values[t.middle[j]] + values[t.middle[k]]);
    look(values[t.inner] - inner, of_bubble);
    out.squared = mesh.area(triangle) * square;
    return out;
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
    const double least = least_findable(missing, limits.unfindable_area);
    std::vector<std::uint32_t> coarse;
    for (std::uint32_t t = 0; t < misfits.size(); ++t)
        if ((misfits[t].squared > share || missing[t] > least) && mesh.longest_edge(t) > limits.shortest_edge)
            coarse.push_back(t);
    return coarse;
}

}  // namespace exitance
