#include "exitance/lab/classical/classical_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace exitance {
namespace {

/// Methods that have a classical form, in the order in which `auto` tries them.
constexpr std::array<Method, 5> classical_methods{Method::matrix, Method::progressive, Method::substructuring,
                                                  Method::hierarchical, Method::wavelet};

/// An option that is set, and the methods that support it.
struct Asked {
    std::string option;
    std::vector<Method> methods;
};

const std::vector<Method> all_methods(classical_methods.begin(), classical_methods.end());
const std::vector<Method> of_matrix{Method::matrix};
const std::vector<Method> shooting{Method::progressive, Method::substructuring};
const std::vector<Method> of_constants{Method::matrix, Method::progressive, Method::substructuring};
const std::vector<Method> linked{Method::hierarchical, Method::wavelet};
const std::vector<Method> no_method;

void add_transfer(const SolveOptions& o, const ClassicalOptions& c, std::vector<Asked>& asked) {
    const auto add = [&](bool is_set, std::string option, const std::vector<Method>& methods) {
        if (is_set) asked.push_back({std::move(option), methods});
    };
    add(o.form_factors == FormFactorKind::analytic, "--form-factors analytic", of_matrix);
    add(o.form_factors && *o.form_factors != FormFactorKind::analytic,
        fmt::format("--form-factors {}", o.form_factors ? name_in(form_factor_names, *o.form_factors) : ""),
        {Method::matrix, Method::progressive});
    add(o.hemicube_cells.has_value(), "--hemicube-cells", {Method::matrix, Method::progressive});
    add(c.receivers.has_value(),
        fmt::format("--form-factors {}", c.receivers ? name_in(shooting_receiver_names, *c.receivers) : ""), shooting);
    add(o.visibility == VisibilityKind::quadrature, "--visibility quadrature", linked);
    add(o.visibility == VisibilityKind::exact, "--visibility exact", linked);
    add(!o.triage, "--triage", linked);
    add(c.kernel.has_value(), "--kernel", linked);
}

/// Returns all options that are set and that not every method supports.
std::vector<Asked> asked_for(const SolveOptions& o, const ClassicalOptions& c) {
    std::vector<Asked> asked;
    const auto add = [&](bool is_set, std::string option, const std::vector<Method>& methods) {
        if (is_set) asked.push_back({std::move(option), methods});
    };
    add(c.mesh == MeshKind::aligned, "--mesh aligned", of_constants);
    add(c.threshold.has_value(), "--threshold", linked);
    add(o.oracle != LinkOracle::transport, "--oracle", linked);
    add(c.multigrid.has_value(), "--multigrid", linked);
    add(o.min_area.has_value(), "--min-area", {Method::substructuring, Method::hierarchical, Method::wavelet});
    add(c.refine_gradient.has_value(), "--refine-gradient", {Method::substructuring});
    add(c.refine.has_value(), "--refine", {Method::substructuring});
    add(c.ambient, "--ambient", shooting);
    add(o.overshooting, "--overshooting", shooting);
    add(c.relaxation.has_value() || c.sor_factor, "--relaxation sor or direct", of_matrix);
    add(o.relaxation && *o.relaxation != Relaxation::southwell && *o.relaxation != Relaxation::jacobi, "--relaxation",
        of_matrix);
    add(o.relaxation == Relaxation::jacobi, "--relaxation jacobi",
        {Method::matrix, Method::hierarchical, Method::wavelet});
    add(o.relaxation == Relaxation::southwell, "--relaxation southwell", of_constants);
    add(!c.snapshots.shots.empty(), "--snapshots shots", shooting);
    add(c.snapshots.rounds, "--snapshots rounds", {Method::matrix, Method::hierarchical, Method::wavelet});
    add_transfer(o, c, asked);
    add(o.bounces != all_bounces, "--bounces", no_method);
    add(!o.importance.empty(), "--importance", no_method);
    add(o.clusters == true, "--clusters on", no_method);
    add(o.keep_links, "--keep-links", no_method);
    add(o.epsilon.has_value(), "--epsilon", no_method);
    add(o.error_interpolant.has_value(), "--error-interpolant", no_method);
    add(c.certify == true, "--certify on", no_method);
    return asked;
}

Error unsupported(const Asked& asked, Method method) {
    const std::string hint =
        asked.methods.empty() ? "leave it out, or leave out the options of classical forms (docs/classical.md)" : "";
    std::vector<std::string_view> names;
    for (Method m : asked.methods) names.push_back(name_in(method_names, m));
    const std::string who = names.empty() ? "no classical form obeys it"
                                          : fmt::format("method {} does not obey it; these do: {}",
                                                        name_in(method_names, method), fmt::join(names, ", "));
    return {ErrorCode::usage, who, asked.option, hint};
}

Result<void> check_pairs(const SolveOptions& o, const ClassicalOptions& c) {
    const auto needs = [](const char* option, const char* other) {
        return Error{ErrorCode::usage, fmt::format("goes with {}", other), option, ""};
    };
    if (c.threshold && o.oracle == LinkOracle::transport) return needs("--threshold", "--oracle ff or bf");
    if (o.oracle != LinkOracle::transport && !c.threshold) return needs("--oracle", "--threshold in classical forms");
    if (c.multigrid && !c.threshold) return needs("--multigrid", "--oracle ff or bf and --threshold");
    if (c.refine && !c.refine_gradient) return needs("--refine", "--refine-gradient");
    if (c.sor_factor && c.relaxation != ClassicalRelaxation::sor) return needs("--sor-factor", "--relaxation sor");
    const bool krylov = o.relaxation == Relaxation::cg || o.relaxation == Relaxation::gmres ||
                        o.relaxation == Relaxation::chebyshev || c.relaxation == ClassicalRelaxation::direct;
    if (c.snapshots.any() && krylov)
        return Error{ErrorCode::usage, "are there of jacobi, gauss-seidel, sor and southwell alone", "--snapshots", ""};
    return {};
}

}  // namespace

Result<Method> classical_method(const SolveOptions& options, const ClassicalOptions& classical) {
    const std::vector<Asked> asked = asked_for(options, classical);
    const auto obeys = [&](Method method, const Asked& a) {
        return std::find(a.methods.begin(), a.methods.end(), method) != a.methods.end();
    };
    if (const Result<void> pairs = check_pairs(options, classical); !pairs) return pairs.error();
    const bool has_form = std::find(all_methods.begin(), all_methods.end(), options.method) != all_methods.end();
    if (options.method != Method::automatic && !has_form)
        return Error{ErrorCode::usage,
                     fmt::format("{} has no classical form; matrix, progressive, substructuring, hierarchical and "
                                 "wavelet have one",
                                 name_in(method_names, options.method)),
                     "--method", ""};
    if (options.method == Method::matrix && options.basis && *options.basis != BasisKind::constant)
        return Error{ErrorCode::usage, "the classical matrix has constant elements; wavelet has higher orders",
                     "--basis", ""};
    for (Method method : all_methods) {
        if (options.method != Method::automatic && options.method != method) continue;
        const auto broken = std::find_if(asked.begin(), asked.end(), [&](const Asked& a) { return !obeys(method, a); });
        if (broken == asked.end()) return method;
        if (options.method == method || broken->methods.empty()) return unsupported(*broken, method);
    }
    return Error{ErrorCode::usage, "no method obeys all of the options of classical forms together", "--method", ""};
}

}  // namespace exitance
