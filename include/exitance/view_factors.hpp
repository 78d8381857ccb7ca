#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exitance/progress.hpp"
#include "exitance/scene.hpp"

namespace exitance::api {

/// Options of view factors.
struct ViewFactorOptions {
    double error = 1e-3;     ///< Limit on the error of every row, which one row in 100 exceeds.
    double smallest = 0;     ///< Smaller entries are dropped.
    std::uint64_t seed = 1;  ///< Seed of the random points.
    /// Relative error of every entry above 1e-6. It replaces `error`. Entries are then computed without rays, which is
    /// slower. Not for operators.
    std::optional<double> tolerance = {};
    std::optional<double> time_limit = {};  ///< Seconds; then the computation stops.
    int threads = 0;                        ///< 0: as set by set_threads().
};

/// View factors between the faces of a scene as compressed sparse rows: F_ij is the share of the diffuse flux leaving
/// face i that reaches the front of face j directly. A_i F_ij = A_j F_ji up to rounding.
struct ViewFactors {
    std::vector<double> areas;           ///< Per face, m^2.
    std::vector<double> emittances;      ///< Per face: 1 - reflectance, mean over the bands.
    std::vector<std::size_t> starts;     ///< Row i is in [starts[i], starts[i + 1]) of `columns` and `values`.
    std::vector<std::uint32_t> columns;  ///< Ascending within a row.
    std::vector<double> values;
    std::vector<double> row_sums;    ///< Never normalized: 1 up to the error in a closed scene.
    std::vector<double> row_errors;  ///< Standard deviation of every row, with its bounds; empty with a tolerance.
    std::vector<double> sky = {};    ///< Per face: share of its flux that leaves the scene; empty with a tolerance.
    std::vector<double> back = {};   ///< Per face: share that reaches the backs of faces; empty with a tolerance.
    std::vector<std::uint8_t> finished = {};  ///< 1 for each row that was computed before a stop; empty: all.
    bool is_complete = true;  ///< False after a stop: other rows are empty, and the finished ones are not reciprocal.
};

/// Computes the view factors of a scene. Faces block light from both sides and receive it at their front. Same bits on
/// any number of threads. A stop or the time limit keeps the finished rows.
/// Errors: usage for options out of range; limit after a stop before the first row.
Result<ViewFactors> view_factors(const Scene& scene, const ViewFactorOptions& options = {},
                                 const Control& control = {});

struct TransportOperatorData;

/// Transport between the faces of a scene, for solvers that need products with the matrix F of view factors only. Far
/// faces share entries, so that it suits 10^5 to 10^6 faces. Products err by at most `error` max |x|; this is at least
/// 1.3 standard deviations for any x.
class TransportOperator {
  public:
    std::size_t size() const;                       ///< Number of faces.
    const std::vector<double>& areas() const;       ///< Per face, m^2.
    const std::vector<double>& emittances() const;  ///< Per face: 1 - reflectance, mean over the bands.
    const std::vector<double>& sky() const;         ///< Per face: share of its flux that leaves the scene.
    const std::vector<double>& back() const;        ///< Per face: share that reaches the backs of faces.
    const std::vector<double>& row_errors() const;  ///< Per face: estimated standard deviation of a product.
    double closure_defect() const;                  ///< Largest |1 - sum_j F_ij - sky_i - back_i|.

    /// F x: a gathering of values of faces. Same bits on any number of threads.
    /// Errors: usage if x has not one value per face.
    Result<std::vector<double>> apply(const std::vector<double>& x) const;
    /// F^T x, the adjoint. Errors as for apply().
    Result<std::vector<double>> apply_transposed(const std::vector<double>& x) const;
    /// Writes an .h5 file, which `exitance heat` reads, too. It appears whole or not at all. Error: cannot_write.
    Result<void> save(const std::string& path) const;

    /// For the library.
    explicit TransportOperator(std::shared_ptr<const TransportOperatorData> data) : data_(std::move(data)) {}

  private:
    std::shared_ptr<const TransportOperatorData> data_;
};

/// Computes the transport between the faces of a scene: the view factors of each face from rays and closed forms, of
/// which the small ones are merged in a tree over the faces. `options.error` bounds products for |x| <= 1. Time and
/// memory grow in proportion to the number of faces. Same bits on any number of threads.
/// Errors: usage for options out of range; limit after a stop, since an operator needs all rows.
Result<TransportOperator> transport_operator(const Scene& scene, const ViewFactorOptions& options = {.error = 1e-2},
                                             const Control& control = {});

/// Reads a file of TransportOperator::save() or of `exitance viewfactors --operator`.
/// Errors: cannot_read, bad_input.
Result<TransportOperator> load_transport_operator(const std::string& path);

/// Writes view factors; the ending selects the format: .vf (View3D), .mtx (Matrix Market), .h5 or .csv. The file
/// appears whole or not at all. Error: cannot_write.
Result<void> save(const ViewFactors& factors, const std::string& path);

}  // namespace exitance::api
