#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/view_factors/exchange_areas.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Stefan and Boltzmann's constant, W/(m^2 K^4). Derived from the constants of the SI; source: CODATA 2018.
constexpr double stefan_boltzmann = 5.670374419e-8;

/// Derived from double precision: with lower emissivities of all surfaces, rounding would determine the result.
constexpr double min_emissivity = 1e-12;

/// Thermal state of a surface: gray, diffuse and opaque. Either its temperature or its net heat is given.
struct ThermalSurface {
    /// Emissivity, from `min_emissivity` to 1. The default is derived from paint and masonry, see ISO 6946.
    double emissivity = 0.9;
    std::optional<double> temperature = {};  ///< K
    double heat = 0;  ///< Net radiative heat that leaves the surface, W; used if there is no temperature. 0: adiabatic.
};

/// Radiative heat transfer between surfaces.
struct GrayExchange {
    std::vector<double> temperature;  ///< Temperature of each surface, K.
    std::vector<double> radiosity;    ///< W/m^2
    std::vector<double> heat;         ///< Net radiative heat that leaves each surface, W.
    double surroundings = 0;          ///< Net heat that the surroundings receive, W; 0 without surroundings.
    double residual = 0;              ///< Residual of the linear system, relative to its right-hand side.
    std::size_t iterations = 0;
};

/// Solves for the radiosities J of gray, diffuse, opaque surfaces,
///
///     J_i = e_i sigma T_i^4 + (1 - e_i) H_i,  H_i = sum_j F_ij J_j + (1 - sum_j F_ij) sigma T_s^4,   T_i given,
///     A_i (J_i - H_i) = Q_i,                                                                         Q_i given,
///
/// by conjugate gradients on the symmetric system that results from multiplying by A_i / (1 - e_i), A_i F_ij being
/// symmetric. `surroundings`: T_s, K; empty: the surfaces form an enclosure, and the missing part of a row's sum due to
/// the factors' error (at most 1% and three times the row's error) is not lost but distributed in proportion to the
/// row.
/// A surface's net heat is exact for these factors: the heats of all surfaces and of the surroundings add up to 0.
/// Errors: ErrorCode::bad_input for values out of range, or if nothing determines the level of temperatures;
/// ErrorCode::limit if a stop is requested. O(entries) per iteration; iterations grow with the mean number of
/// reflections. Source: [Hottel54], [Howell20].
Result<GrayExchange> solve_gray_exchange(const SparseFactors& factors, std::span<const ThermalSurface> surfaces,
                                         std::optional<double> surroundings, const StopRequest& stop);

/// Like the above, for an operator. It uses the mean of F and of its reciprocal A^-1 F^T A, so that all heats add up to
/// 0 although the operator's nodes are not reciprocal. Entries are merged only if they are small in both directions, so
/// that this mean has about the operator's error; rows are closed as those of a table.
Result<GrayExchange> solve_gray_exchange(const FactorOperator& transport, std::span<const ThermalSurface> surfaces,
                                         std::optional<double> surroundings, const StopRequest& stop);

/// True if the rows of a table add up to 1, up to 1% and three times their errors.
bool is_enclosure(const SparseFactors& factors);

/// Exchange factors of gray surfaces (script F): row i holds the shares of the black-body power A_i sigma T_i^4 that
/// surface i would emit that are emitted by i and absorbed by j, so that j receives A_i f_ij sigma (T_i^4 - T_j^4) from
/// i. Gebhart's factors are f_ij / e_i. Row after row; surfaces without a temperature are taken as adiabatic. Cost: one
/// solution of the system per surface. Errors as above.
Result<std::vector<std::vector<double>>> exchange_factors(const SparseFactors& factors,
                                                          std::span<const ThermalSurface> surfaces,
                                                          std::optional<double> surroundings, const StopRequest& stop);

}  // namespace exitance
