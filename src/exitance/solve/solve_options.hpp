#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "exitance/base/schedule.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/links/error/link_oracle.hpp"
#include "exitance/solve/classical_options.hpp"
#include "exitance/solve/discontinuity_choice.hpp"
#include "exitance/solve/relaxation.hpp"

namespace exitance {

enum class Method {
    automatic,
    matrix,
    progressive,
    substructuring,
    hierarchical,
    wavelet,
    monte_carlo,
    discontinuity,
    growing_cells
};
enum class BasisKind {
    constant,
    linear,
    galerkin1,
    galerkin2,
    galerkin3,
    haar,
    flatlet2,
    flatlet3,
    multiwavelet2,
    multiwavelet3
};
enum class VisibilityKind { automatic, fractional, quadrature, exact };
enum class FormFactorKind { analytic, ray_cast, hemicube };
/// Growing cells as published, with all light in the networks, or with separate direct light and analytic kernels.
enum class CellsKind { classic, improved };
/// For discontinuity meshing: how light at a point is computed from the global pass. See
/// lab/local_passes/local_passes.hpp.
enum class LocalPassRule { a, b, c, d, e };

/// User-visible name of each choice. `--help`, the parser, the recorded options and the statistics use these tables.
inline constexpr std::array<std::pair<Method, std::string_view>, 9> method_names{{
    {Method::automatic, "auto"},
    {Method::matrix, "matrix"},
    {Method::progressive, "progressive"},
    {Method::substructuring, "substructuring"},
    {Method::hierarchical, "hierarchical"},
    {Method::wavelet, "wavelet"},
    {Method::monte_carlo, "monte-carlo"},
    {Method::discontinuity, "discontinuity"},
    {Method::growing_cells, "growing-cells"},
}};
inline constexpr std::array<std::pair<BasisKind, std::string_view>, 10> basis_names{{
    {BasisKind::constant, "constant"},
    {BasisKind::linear, "linear"},
    {BasisKind::galerkin1, "galerkin1"},
    {BasisKind::galerkin2, "galerkin2"},
    {BasisKind::galerkin3, "galerkin3"},
    {BasisKind::haar, "haar"},
    {BasisKind::flatlet2, "flatlet2"},
    {BasisKind::flatlet3, "flatlet3"},
    {BasisKind::multiwavelet2, "multiwavelet2"},
    {BasisKind::multiwavelet3, "multiwavelet3"},
}};
inline constexpr std::array<std::pair<Relaxation, std::string_view>, 6> relaxation_names{{
    {Relaxation::jacobi, "jacobi"},
    {Relaxation::gauss_seidel, "gauss-seidel"},
    {Relaxation::cg, "cg"},
    {Relaxation::gmres, "gmres"},
    {Relaxation::southwell, "southwell"},
    {Relaxation::chebyshev, "chebyshev"},
}};
inline constexpr std::array<std::pair<VisibilityKind, std::string_view>, 4> visibility_names{{
    {VisibilityKind::automatic, "auto"},
    {VisibilityKind::fractional, "fractional"},
    {VisibilityKind::quadrature, "quadrature"},
    {VisibilityKind::exact, "exact"},
}};
inline constexpr std::array<std::pair<LinkOracle, std::string_view>, 3> oracle_names{{
    {LinkOracle::transport, "transport"},
    {LinkOracle::form_factor, "ff"},
    {LinkOracle::power, "bf"},
}};
inline constexpr std::array<std::pair<FormFactorKind, std::string_view>, 3> form_factor_names{{
    {FormFactorKind::analytic, "analytic"},
    {FormFactorKind::ray_cast, "ray-cast"},
    {FormFactorKind::hemicube, "hemicube"},
}};

inline constexpr std::array<std::pair<CellsKind, std::string_view>, 2> cells_names{{
    {CellsKind::classic, "classic"},
    {CellsKind::improved, "improved"},
}};

inline constexpr std::array<std::pair<LocalPassRule, std::string_view>, 5> local_pass_names{{
    {LocalPassRule::a, "a"},
    {LocalPassRule::b, "b"},
    {LocalPassRule::c, "c"},
    {LocalPassRule::d, "d"},
    {LocalPassRule::e, "e"},
}};

/// True for constant to quadratic functions on leaves that are linked pair by pair, without a hierarchy.
constexpr bool is_galerkin(BasisKind basis) {
    return basis == BasisKind::galerkin1 || basis == BasisKind::galerkin2 || basis == BasisKind::galerkin3;
}

/// True if the elements of a method support this basis.
constexpr bool fits(BasisKind basis, Method method) {
    const bool of_matrix = basis == BasisKind::constant || basis == BasisKind::linear || is_galerkin(basis);
    if (method == Method::automatic || method == Method::matrix) return of_matrix;
    if (method == Method::wavelet) return !of_matrix;
    if (method == Method::growing_cells) return false;  // always Gaussians
    return basis == (method == Method::hierarchical ? BasisKind::haar : BasisKind::constant);
}

/// Name of a choice in its table.
template <class Choice, std::size_t N>
constexpr std::string_view name_in(const std::array<std::pair<Choice, std::string_view>, N>& table, Choice choice) {
    for (const auto& [value, name] : table)
        if (value == choice) return name;
    return {};
}

inline constexpr int all_bounces = -1;
inline constexpr double default_error = 0.02;  ///< Relative RMS error, of radiosity.
/// Rays per pair of elements of methods that sample the visibility of pairs.
inline constexpr std::size_t default_visibility_samples = 16;

/// A point at which irradiance is wanted, and the unit normal of the receiving plane there.
struct ImportantPoint {
    Point at;
    Normal normal;
};

/// Times at which a published form shows intermediate solutions: at these seconds of its own time, after these shots,
/// or after every round (sweep, iteration, attempt).
struct SnapshotPlan {
    std::vector<double> seconds = {};
    std::vector<std::size_t> shots = {};
    bool rounds = false;

    bool any() const { return rounds || !seconds.empty() || !shots.empty(); }
};

/// Options of a solve. An empty optional is chosen by the method from the required error. A parameter that is set is
/// used as given, and no error is then required by default.
struct SolveOptions {
    Method method = Method::automatic;
    std::optional<BasisKind> basis = {};
    int bounces = all_bounces;  ///< Reflections: 0: none; n: at most n; all_bounces: until convergence.

    /// Relative RMS error of the light that `probe` evaluates; empty: see error_demand().
    std::optional<double> error = {};
    /// Relative RMS error of the exported mesh; empty: not limited.
    std::optional<double> error_interpolant = {};

    std::optional<double> epsilon = {};    ///< Tolerance for the total error of all links, relative RMS.
    std::optional<double> mesh_size = {};  ///< Longest edge of an element, metres.
    std::optional<double> residual = {};   ///< Residual of the discrete system, relative to its right-hand side.
    std::optional<std::size_t> max_iterations = {};  ///< Maximum number of sweeps, Krylov steps or shots.
    std::optional<double> min_area = {};             ///< Smallest area of the parts of a split element, m^2.
    std::optional<Relaxation> relaxation = {};
    bool overshooting = false;  ///< Shooting also sends an estimate of the light that will be reflected back.

    VisibilityKind visibility = VisibilityKind::automatic;
    std::optional<double> threshold = {};  ///< Threshold of the oracles ff (no unit) and bf (W in the brightest band).
    bool task_engine = false;              ///< Use the task engine (lab/tasks) for classical hierarchical radiosity.
    std::optional<std::size_t> visibility_samples = {};  ///< Rays per pair of elements.
    bool triage = true;  ///< Links test for certain visibility or occlusion before they cast rays.
    LinkOracle oracle = LinkOracle::transport;  ///< Criterion by which links are accepted or refined.
    std::optional<bool> clusters = {};  ///< True: also link clusters of pieces. Empty: do so if there are many pieces.
    std::optional<FormFactorKind> form_factors = {};
    std::optional<std::size_t> hemicube_cells = {};  ///< Cells along an edge of a hemicube's top.
    std::optional<CellsKind> gcs = {};               ///< Variant of growing cells; empty: improved.
    std::optional<std::size_t> max_units = {};       ///< Limit on the units of each network of growing cells.
    std::optional<LocalPassRule> local_pass = {};    ///< Local pass of discontinuity meshing; empty: e.
    /// Use the values of the method's elements instead of a final gather: smoothed (true) or unchanged (false). Empty:
    /// the most accurate choice.
    std::optional<bool> smoothing = {};
    /// Points at which irradiance is wanted; links are refined for accuracy there [Smits92]. Empty: uniform accuracy.
    std::vector<ImportantPoint> importance = {};
    bool keep_links = false;  ///< Store the links of a hierarchy in the solution, for display.

    DiscontinuityChoice discontinuity = {};  ///< Options of discontinuity meshing.
    ClassicalOptions classical = {};         ///< Options of classical forms; any of them selects such a form.
    SnapshotPlan snapshots = {};             ///< Intermediate solutions of a published form.

    int threads = 0;                         ///< Number of threads; 0: all cores. Results do not depend on it.
    Schedule schedule = Schedule::stealing;  ///< How work is distributed to threads. Results do not depend on it.
    std::uint64_t seed = 1;
    std::optional<std::size_t> memory_limit_bytes = {};  ///< Memory limit of the whole process.

    /// True if a parameter is set that would otherwise be derived from the required error.
    bool has_knobs() const {
        return epsilon || mesh_size || residual || max_iterations || min_area || visibility_samples || hemicube_cells ||
               max_units;
    }
    /// Required error: `error` if given; else empty if parameters were set by hand, for the task engine and with
    /// important points; else `default_error`. With important points it is the error there.
    std::optional<double> error_demand() const {
        if (error) return error;
        return has_knobs() || task_engine || !importance.empty() ? std::nullopt : std::optional(default_error);
    }
    /// Error from which unset parameters are derived.
    double error_target() const { return error.value_or(default_error); }
};

}  // namespace exitance
