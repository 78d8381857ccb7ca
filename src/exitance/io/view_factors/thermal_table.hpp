#pragma once

#include <string>
#include <vector>

#include "exitance/view_factors/gray_exchange.hpp"

namespace exitance {

/// Reads the thermal state of the surfaces of a table of view factors from a CSV file with a header: `surface` (its
/// number from 1 in the table, or its name; 0: all surfaces), and any of `emissivity`, `temperature` (K) and `heat`
/// (net heat that leaves the surface, W). Rows are applied in order; an empty field leaves the value as it is, a
/// temperature replaces a heat and the reverse. Surfaces without a row are adiabatic and have the emissivity of the
/// view factors' file. Errors: cannot_read; bad_input for unknown columns, rows of another length, a surface that does
/// not exist, values out of range, and a row with both a temperature and a heat.
Result<std::vector<ThermalSurface>> read_thermal_table(const std::string& path, const SparseFactors& factors);

/// Returns surfaces with the emissivities of the view factors' file, which are 1 - reflectance. They are adiabatic.
std::vector<ThermalSurface> emissivities_of(const SparseFactors& factors);

/// Formats a heat balance as CSV: `surface,area,emissivity,temperature,radiosity,heat`, one row per surface; m^2, K,
/// W/m^2 and W. With 17 digits, reading restores the same doubles.
std::string heat_csv(const SparseFactors& factors, const std::vector<ThermalSurface>& surfaces,
                     const GrayExchange& exchange);

/// Formats exchange factors as CSV: `surface,area,emissivity,f_1,...,f_n`, one row per surface.
std::string exchange_csv(const SparseFactors& factors, const std::vector<ThermalSurface>& surfaces,
                         const std::vector<std::vector<double>>& f);

}  // namespace exitance
