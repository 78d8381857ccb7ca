#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "exitance/view_factors/face_tree.hpp"
#include "exitance/view_factors/row_factors.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Transport between the faces of a scene, for solvers that need products with the matrix F of view factors only:
///
///     (F x)_i = sum_j N_ij x_j + sum_C T_iC mean_C(x),   mean_C(x) = sum_{j in C} A_j x_j / sum_{j in C} A_j
///
/// over faces j, near or large, and nodes C of a tree over the faces, far or small: T_iC is the sum of the view factors
/// from i to the faces of C that it replaces. Row sums are therefore exactly those of the table from which it is made.
/// Memory: 12 bytes per entry and 64 per face.
struct FactorOperator {
    FaceTree tree;
    /// Rows with the areas, sums, errors and shares of sky and backs of all faces. A column below size() is a face; the
    /// others are nodes of `tree`, from size() on. `row_errors` includes the error of the nodes.
    SparseFactors rows;

    std::size_t size() const { return rows.size(); }

    /// y = F x. x and y: one number per face; they must not overlap. Same bits on any number of threads. 5 ns an entry.
    void apply(std::span<const double> x, std::span<double> y) const;
    /// y = F^T x, the exact adjoint of apply(). Runs on one thread.
    void apply_transposed(std::span<const double> x, std::span<double> y) const;
    /// Row i of F with one entry per face.
    std::vector<double> dense_row(std::size_t i) const;

    std::size_t node_entries() const;  ///< Number of entries for nodes.
    /// max_i |1 - (F 1)_i - sky_i - back_i| over the finished rows; 0 if the shares of the sky are not known.
    double closure_defect() const;
};

/// Shares of the error R of an operator for the errors of its table's rows and of its nodes. These are standard
/// deviations for any x. Since R limits the errors of products themselves, the shares are smaller than 1 / sqrt(2):
/// measured by `exitance viewfactors complex200.obj --operator F.h5 --error 1e-2 --check 500 --check-rays 200000`, no
/// sum over a row or one of 16 groups is off by more than R, where shares of 0.8 and 0.6 miss R in 2% of the rows.
/// The sum of a row is off by as much as its shares of the sky and of backs: these get 0.3, derived from 3.3 standard
/// deviations, which one value in 1,000 exceeds.
inline constexpr double table_share = 0.5, node_share = 0.5, missed_share = 0.3;

/// Options of the table of which an operator of a given error is made.
inline RowFactorOptions operator_table_options(double error, double smallest, std::uint64_t seed) {
    return {.error = table_share * error,
            .deviations = 0,
            .smallest = smallest,
            .missed_error = missed_share * error,
            .seed = seed};
}

/// Merges the smallest entries of every row of a table into nodes of a tree over the faces. Whatever the occlusion, a
/// node changes a product by at most T_iC (max x - min x) over its faces, hence not at all if x is constant there. Of
/// all thresholds for T_iC, each row uses the largest with sqrt(sum_C T_iC^2) <= `error`; this sum is added to the
/// row's variance. An entry F_ij is merged only if F_ji is below the threshold of row j, too. Without this condition,
/// the row of a floor would merge the undersides of chairs, although these exchange most of their light with the floor,
/// and F^T would be wrong there. Nodes are as small as possible, and a node replaces at least two entries.
/// O(entries log faces).
/// faces  in the order of the table's rows
/// table  combined rows, so that A_i F_ij = A_j F_ji
FactorOperator make_factor_operator(std::span<const ViewFace> faces, SparseFactors table, double error);

}  // namespace exitance
