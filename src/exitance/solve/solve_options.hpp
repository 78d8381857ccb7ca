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
/// Growing cells as published, all light through the networks, or with direct light apart and analytic kernels.
enum class CellsKind { classic, improved };
/// Of discontinuity meshing: how light at a place is found from the global pass. See lab/local_passes/local_passes.hpp.
enum class LocalPassRule { a, b, c, d, e };

/// What users call each choice. `--help`, the parser, the recorded options and the statistics all read these tables.
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

/// Constants to quadratic functions on leaves that are linked pair by pair, without a hierarchy.
constexpr bool is_galerkin(BasisKind basis) {
    return basis == BasisKind::galerkin1 || basis == BasisKind::galerkin2 || basis == BasisKind::galerkin3;
}

/// Can the elements of a method hold this basis?
constexpr bool fits(BasisKind basis, Method method) {
    const bool of_matrix = basis == BasisKind::constant || basis == BasisKind::linear || is_galerkin(basis);
    if (method == Method::automatic || method == Method::matrix) return of_matrix;
    if (method == Method::wavelet) return !of_matrix;
    if (method == Method::growing_cells) return false;  // Gaussians, without a choice
    return basis == (method == Method::hierarchical ? BasisKind::haar : BasisKind::constant);
}

/// The name of a choice in its table.
template <class Choice, std::size_t N>
constexpr std::string_view name_in(const std::array<std::pair<Choice, std::string_view>, N>& table, Choice choice) {
    for (const auto& [value, name] : table)
        if (value == choice) return name;
    return {};
}

inline constexpr int all_bounces = -1;
inline constexpr double default_error = 0.02;  ///< Relative RMS error, of radiosity.

/// A point where light is looked at, and the direction in which the receiving plane faces there, of length 1.
struct ImportantPoint {
    Point at;
    Normal normal;
};

/// What a solve is asked for. An empty optional leaves the choice to the method, which derives it from the error asked
/// for; a knob that is set by hand is used as it stands and lifts the default demand.
struct SolveOptions {
    Method method = Method::automatic;
    std::optional<BasisKind> basis = {};
    int bounces = all_bounces;  ///< 0: direct light alone; n: at most n reflections; all_bounces: until convergence.

    std::optional<double> error = {};  ///< Relative RMS error of what `probe` evaluates; empty: see error_demand().
    /// Relative RMS error of what `export` writes; empty: as the method comes by.
    std::optional<double> error_interpolant = {};

    std::optional<double> epsilon = {};              ///< Error of all links together, relative RMS.
    std::optional<double> mesh_size = {};            ///< Longest edge of an element, metres.
    std::optional<double> residual = {};             ///< Of the discrete system, relative to its right-hand side.
    std::optional<std::size_t> max_iterations = {};  ///< Sweeps, Krylov steps or shots.
    std::optional<double> min_area = {};             ///< No element is cut to pieces smaller than this, m^2.
    std::optional<Relaxation> relaxation = {};
    bool overshooting = false;  ///< Shooting sends more than the unshot light, expecting what returns.

    VisibilityKind visibility = VisibilityKind::automatic;
    std::optional<double> threshold = {};  ///< Of the oracles ff (no unit) and bf (W in the brightest band).
    bool task_engine = false;              ///< Classical hierarchical radiosity as tasks that make tasks.
    std::optional<std::size_t> visibility_samples = {};  ///< Rays a pair of elements.
    bool triage = true;  ///< Links look for what is certainly visible or hidden before they cast rays.
    LinkOracle oracle = LinkOracle::transport;  ///< By what links are held to be good enough.
    std::optional<bool> clusters = {};  ///< Links between clusters of pieces, too; empty: where pieces are many.
    std::optional<FormFactorKind> form_factors = {};
    std::optional<std::size_t> hemicube_cells = {};  ///< Along an edge of a hemicube's top.
    std::optional<CellsKind> gcs = {};               ///< Of growing cells; empty: improved.
    std::optional<std::size_t> max_units = {};       ///< Of each network of growing cells.
    std::optional<LocalPassRule> local_pass = {};    ///< Of discontinuity meshing; empty: e.
    /// Deliver what the method's elements hold in place of gathering it: smoothed (true) or as it is. Empty: whatever
    /// is best.
    std::optional<bool> smoothing = {};
    /// Points where light is looked at; links are refined for their sake. Empty: light is as good everywhere.
    std::vector<ImportantPoint> importance = {};
    bool keep_links = false;  ///< Put the links of a hierarchy into the solution, for people to look at.

    DiscontinuityChoice discontinuity = {};  ///< Of discontinuity meshing.

    int threads = 0;                         ///< 0: all cores. Results do not depend on it.
    Schedule schedule = Schedule::stealing;  ///< How work comes to threads. Likewise.
    std::uint64_t seed = 1;
    std::optional<std::size_t> memory_limit_bytes = {};  ///< Of the whole process.

    /// Has any of the knobs been set that the error asked for would otherwise decide?
    bool has_knobs() const {
        return epsilon || mesh_size || residual || max_iterations || min_area || visibility_samples || hemicube_cells ||
               max_units;
    }
    /// The error to be reached: as asked for; `default_error` when nothing was said; none when knobs were set by hand.
    /// Where points are looked at, it is the error there.
    std::optional<double> error_demand() const {
        if (error) return error;
        return has_knobs() || task_engine || !importance.empty() ? std::nullopt : std::optional(default_error);
    }
    /// The error that knobs left open are derived from.
    double error_target() const { return error.value_or(default_error); }
};

}  // namespace exitance
