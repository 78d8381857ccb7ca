#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exitance/view_factors/view_factors.hpp"

namespace exitance {

/// View factors between all faces of a scene as compressed rows, in the order of its file. F_ij is the share of the
/// diffuse flux leaving face i that reaches the front of face j directly.
struct SparseFactors {
    std::vector<double> areas;       ///< Area of every face, m^2.
    std::vector<double> emittances;  ///< 1 - reflectance, mean over the bands, one per face.
    /// Start of each row in `columns` and `values`, and the end of the last one.
    std::vector<std::size_t> starts = {0};
    std::vector<std::uint32_t> columns;  ///< Column of each entry, ascending within a row.
    std::vector<double> values;

    std::vector<double> row_sums;  ///< Sum of each row's factors, one value per face.
    /// Shares of the flux leaving each face that leave the scene, and that reach the back of a face or start below
    /// another face. Found by rays. Empty if they were not computed.
    std::vector<double> sky, back;
    /// Error of each row, sqrt(sum of variances) + sum of bounds; infinite if not finished. Empty for a table with a
    /// tolerance of entries.
    std::vector<double> row_errors;
    std::vector<std::string> names;      ///< Name of each row; empty: rows have numbers only.
    std::vector<double> dropped;         ///< Sum of the entries of each row that were dropped as too small.
    std::vector<std::uint8_t> finished;  ///< 1 for each computed row, otherwise 0.
    bool combined = false;  ///< True if F_ij and F_ji combine both rows, so that A_i F_ij = A_j F_ji up to rounding.

    double reciprocity_defect = 0;  ///< max |A_i F_ij - A_j F_ji| / (A_i max_j F_ij) of independently computed rows.
    double entry_defect = 0;        ///< See ViewFactors; 0 for tables with an error per row.
    /// max |1 - sum_j F_ij - share of the sky and of backs| over independently computed rows whose share is known to
    /// the requested error.
    double closure_defect = 0;
    std::size_t unclosed = 0;  ///< Number of rows whose closure defect exceeds the one that their variance explains.

    bool is_settled = true;                 ///< False if the run was stopped after its rows.
    std::size_t mended = 0, unsettled = 0;  ///< See ViewFactors; 0 for tables with an error per row.

    std::size_t size() const { return areas.size(); }
    std::size_t entries() const { return values.size(); }
    std::span<const std::uint32_t> row_columns(std::size_t i) const {
        return std::span(columns).subspan(starts[i], starts[i + 1] - starts[i]);
    }
    std::span<const double> row_values(std::size_t i) const {
        return std::span(values).subspan(starts[i], starts[i + 1] - starts[i]);
    }
};

/// Returns the entries of a table that are not zero and at least `smallest`. Row errors are left empty.
SparseFactors sparse_from(const ViewFactors& table, double smallest = 0);

/// Scales exchange areas A_i F_ij by x_i x_j so that all rows add up to 1, up to 1e-7: for the surfaces of an
/// enclosure. Keeps reciprocity. Rows without entries are not changed.
void close_rows(SparseFactors& table);

inline constexpr std::uint32_t no_row = 0xffffffff;

/// Returns a table whose rows are unions of faces: the row of a union is the area-weighted mean of its faces' rows, and
/// its column is the sum of their columns. Emittances are area-weighted means. `rows` contains the row of every face,
/// or no_row for a face that only blocks; `count` rows are returned. The error of a row is at most the mean of its
/// faces' errors. Defects are those of the faces' table.
SparseFactors merge_rows(const SparseFactors& table, std::span<const std::uint32_t> rows, std::size_t count);

}  // namespace exitance
