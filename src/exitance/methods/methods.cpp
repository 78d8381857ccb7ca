#include "exitance/methods/methods.hpp"

namespace exitance {

std::vector<Spectrum> leaf_means(const DirectProjection& direct, const LeafNumbering& numbering) {
    std::vector<Spectrum> out;
    out.reserve(numbering.leaves.size());
    for (ElementId e : numbering.leaves) out.push_back(direct.fit[e].mean);
    return out;
}

std::span<const MethodEntry> method_table() {
    static constexpr MethodEntry table[] = {
        {Method::matrix, solve_matrix, "constant"},
        {Method::progressive, solve_progressive, "constant"},
        {Method::substructuring, solve_substructuring, "constant"},
        {Method::hierarchical, solve_hierarchical, "haar"},
        {Method::wavelet, solve_wavelet, "multiwavelet2"},
        {Method::monte_carlo, solve_monte_carlo, "constant"},
        // Its own is the direct light; what is reflected is smooth: a hierarchy, on which direct light is projected.
        {Method::discontinuity, solve_hierarchical, "quadratic"},
        {Method::growing_cells, solve_growing_cells, "gaussian"},
    };
    return table;
}

}  // namespace exitance
