#include "exitance/methods/plan/obedience.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "exitance/methods/hierarchical/hierarchical.hpp"

namespace exitance {
namespace {

/// Methods in the order in which `auto` tries them.
constexpr std::array<Method, 8> all_methods{Method::matrix,        Method::hierarchical,   Method::wavelet,
                                            Method::progressive,   Method::substructuring, Method::monte_carlo,
                                            Method::discontinuity, Method::growing_cells};

/// Collects the set options and the methods that support them.
class Obedience {
  public:
    explicit Obedience(const SolveOptions& options) : o_(options) {
        if (o_.bounces <= 0) linked_.push_back(Method::discontinuity);  // limited reflections need `matrix`
    }

    std::vector<AskedOption> asked() {
        add_basis();
        add(o_.epsilon.has_value(), "--epsilon", with_galerkin(linked_),
            "--method matrix: with --basis galerkin1 to 3");
        add(o_.overshooting, "--overshooting", {Method::progressive, Method::substructuring});
        add_relaxation();
        add_visibility();
        add(o_.clusters.has_value(), "--clusters", linked_);
        add(o_.oracle != LinkOracle::transport, "--oracle", linked_);
        add(!o_.importance.empty(), "--importance", linked_);
        add(o_.keep_links, "--keep-links", linked_);
        add_form_factors();
        return std::move(asked_);
    }

  private:
    bool is_constant() const { return !o_.basis || *o_.basis == BasisKind::constant; }
    bool is_galerkin_matrix() const { return o_.basis && is_galerkin(*o_.basis) && o_.bounces < 0; }

    void add(bool is_set, const char* name, std::vector<Method> methods, const char* hint = "") {
        if (is_set) asked_.push_back({name, std::move(methods), hint});
    }

    /// Adds `matrix` if its basis is Galerkin's: its blocks between leaves are then computed like links.
    std::vector<Method> with_galerkin(std::vector<Method> methods) const {
        if (is_galerkin_matrix()) methods.insert(methods.begin(), Method::matrix);
        return methods;
    }

    void add_basis() {
        if (!o_.basis) return;
        std::vector<Method> methods;
        for (Method m : all_methods)
            if (m != Method::discontinuity && fits(*o_.basis, m)) methods.push_back(m);
        add(true, "--basis", methods);
    }

    /// Shooting is Southwell's relaxation, and the random walk Jacobi's. Links that are evaluated one by one are
    /// gathered all at once. Collocated systems and those of higher order are not symmetric, as cg requires.
    void add_relaxation() {
        if (!o_.relaxation) return;
        const Relaxation r = *o_.relaxation;
        const bool at_once = r == Relaxation::jacobi || r == Relaxation::chebyshev || r == Relaxation::gmres;
        std::vector<Method> methods;
        if (is_galerkin_matrix() ? at_once : is_constant() || r != Relaxation::cg) methods.push_back(Method::matrix);
        if (at_once || !asks_for_judged_links(o_)) {
            methods.push_back(Method::hierarchical);
            if (o_.bounces <= 0) methods.push_back(Method::discontinuity);
        }
        if (at_once) methods.push_back(Method::wavelet);
        if (r == Relaxation::southwell) methods.insert(methods.end(), {Method::progressive, Method::substructuring});
        if (r == Relaxation::jacobi) methods.push_back(Method::monte_carlo);
        add(true, "--relaxation", methods, "links that are judged one by one take jacobi, chebyshev and gmres");
    }

    void add_visibility() {
        const bool fractional = o_.visibility == VisibilityKind::fractional;
        std::vector<Method> shared = with_galerkin(linked_), sampled;
        if (is_constant() && o_.form_factors == FormFactorKind::analytic) sampled.push_back(Method::matrix);
        sampled.insert(sampled.end(), {Method::progressive, Method::substructuring});
        std::vector<Method> of_fractions = shared;
        of_fractions.insert(of_fractions.end(), sampled.begin(), sampled.end());
        const char* const hint = "--method matrix: with --form-factors analytic";
        add(fractional, "--visibility fractional", of_fractions, hint);
        add(o_.visibility == VisibilityKind::quadrature, "--visibility quadrature", shared);
        add(o_.visibility == VisibilityKind::exact, "--visibility exact", {},
            "hierarchical and wavelet have it in their classical forms: --direct apart");
        add(o_.visibility_samples.has_value(), "--visibility-samples", sampled, hint);
        add(!o_.triage, "--triage", shared);
    }

    void add_form_factors() {
        const char* const hint = "--method matrix: with --basis constant";
        std::vector<Method> methods;
        if (is_constant()) methods.push_back(Method::matrix);
        std::vector<Method> computed = methods;
        computed.insert(computed.end(), {Method::progressive, Method::substructuring});
        add(o_.form_factors == FormFactorKind::analytic, "--form-factors analytic", computed, hint);
        add(o_.form_factors == FormFactorKind::hemicube, "--form-factors hemicube", methods, hint);
        if (o_.basis == BasisKind::linear) methods.push_back(Method::matrix);  // rows of `linear` are sampled by rays
        add(o_.form_factors == FormFactorKind::ray_cast, "--form-factors ray-cast", methods, hint);
        std::vector<Method> cells;
        if (is_constant() && o_.form_factors == FormFactorKind::hemicube) cells.push_back(Method::matrix);
        add(o_.hemicube_cells.has_value(), "--hemicube-cells", cells, "--method matrix: with --form-factors hemicube");
    }

    const SolveOptions& o_;
    std::vector<Method> linked_{Method::hierarchical, Method::wavelet};
    std::vector<AskedOption> asked_;
};

/// Returns the method that runs: `matrix` if the number of reflections is limited and the method does not support it.
Method in_force(Method method, const SolveOptions& options) {
    return options.bounces > 0 && method != Method::discontinuity ? Method::matrix : method;
}

bool names(const AskedOption& asked, Method method) {
    return std::find(asked.methods.begin(), asked.methods.end(), method) != asked.methods.end();
}

}  // namespace

std::vector<AskedOption> asked_of_methods(const SolveOptions& options) {
    return Obedience(options).asked();
}

bool obeys_all(Method method, const SolveOptions& options) {
    const std::vector<AskedOption> asked = asked_of_methods(options);
    return std::all_of(asked.begin(), asked.end(),
                       [&](const AskedOption& a) { return names(a, in_force(method, options)); });
}

Method first_that_obeys(const SolveOptions& options) {
    const auto found =
        std::find_if(all_methods.begin(), all_methods.end(), [&](Method m) { return obeys_all(m, options); });
    return found == all_methods.end() ? Method::automatic : *found;
}

Result<void> check_obedience(const SolveOptions& options) {
    const std::vector<AskedOption> asked = asked_of_methods(options);
    const bool any = options.method == Method::automatic;
    if (any && first_that_obeys(options) != Method::automatic) return {};
    const Method method = in_force(options.method, options);
    const auto broken =
        std::find_if(asked.begin(), asked.end(), [&](const AskedOption& a) { return any || !names(a, method); });
    if (broken == asked.end()) return {};
    if (any && !broken->methods.empty() && asked.size() > 1)
        return Error{ErrorCode::usage, fmt::format("no method obeys both this and {}", asked[1].name), broken->name,
                     broken->hint};
    std::vector<std::string_view> obeying;
    for (Method m : broken->methods) obeying.push_back(name_in(method_names, m));
    const std::string who = any || obeying.empty()
                                ? "no method obeys it by itself"
                                : fmt::format("method {} does not obey it; these do: {}", name_in(method_names, method),
                                              fmt::join(obeying, ", "));
    return Error{ErrorCode::usage, who, broken->name, broken->hint};
}

}  // namespace exitance
