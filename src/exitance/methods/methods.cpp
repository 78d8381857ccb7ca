#include "exitance/methods/methods.hpp"

#include <algorithm>

#include "exitance/base/check.hpp"
#include "exitance/methods/extensions.hpp"
#include "exitance/methods/options/support.hpp"

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

/// The table: one line per method.
constexpr MethodEntry method_table[] = {
    {Method::matrix, solve_matrix, "constant"},
    {Method::progressive, solve_progressive, "constant"},
    {Method::substructuring, solve_substructuring, "constant"},
    {Method::hierarchical, solve_hierarchical, "haar"},
    {Method::wavelet, solve_wavelet, "multiwavelet2"},
    {Method::monte_carlo, solve_monte_carlo, "constant"},
    {Method::discontinuity, solve_beside_discontinuities, "quadratic"},
};

}  // namespace

const MethodEntry* find_method(Form form, Method id) {
    for (const MethodEntry& method : method_table)
        if (method.form == form && method.id == id) return &method;
    for (const MethodEntry& method : extensions().methods)
        if (method.form == form && method.id == id) return &method;
    return nullptr;
}

const MethodEntry& entry_of(Method id, Form form) {
    const MethodEntry* const method = find_method(form, id);
    EXI_CHECK(method);
    return *method;
}

bool has_estimate(const SolveOptions& options) {
    const Form form = form_of(options);
    const auto is_selected = [&](const MethodEntry& method) {
        return method.form == form && (options.method == Method::automatic || options.method == method.id);
    };
    const auto& added = extensions().methods;
    const auto method = std::find_if(added.begin(), added.end(), is_selected);
    return form == Form::standard || method == added.end() || method->has_estimate;
}

}  // namespace exitance
