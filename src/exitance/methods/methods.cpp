#include "exitance/methods/methods.hpp"

#include <algorithm>

namespace exitance {

std::vector<Spectrum> leaf_means(const DirectProjection& direct, const LeafNumbering& numbering) {
    std::vector<Spectrum> out;
    out.reserve(numbering.leaves.size());
    for (ElementId e : numbering.leaves) out.push_back(direct.fit[e].mean);
    return out;
}

namespace {

/// Finds the reflected light for discontinuity meshing. Since reflected light is smooth, direct light is projected on a
/// hierarchy and transported by links. Only `matrix` supports a limited number of bounces.
GlobalLight solve_beside_discontinuities(const MethodInput& input) {
    return input.options.bounces > 0 ? solve_matrix(input) : solve_hierarchical(input);
}

}  // namespace

std::span<const MethodEntry> method_table() {
    static constexpr MethodEntry table[] = {
        {Method::matrix, solve_matrix, "constant"},
        {Method::progressive, solve_progressive, "constant"},
        {Method::substructuring, solve_substructuring, "constant"},
        {Method::hierarchical, solve_hierarchical, "haar"},
        {Method::wavelet, solve_wavelet, "multiwavelet2"},
        {Method::monte_carlo, solve_monte_carlo, "constant"},
        {Method::discontinuity, solve_beside_discontinuities, "quadratic"},
        {Method::growing_cells, solve_growing_cells, "gaussian"},
    };
    return table;
}

const MethodEntry& entry_of(Method id) {
    const auto table = method_table();
    return *std::find_if(table.begin(), table.end(), [&](const MethodEntry& m) { return m.id == id; });
}

}  // namespace exitance
