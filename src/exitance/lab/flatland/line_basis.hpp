#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace exitance::flatland {

/// Bases of functions on [0, 1] for the study of kernels of two variables.
enum class LineBasis { haar, flatlet2, flatlet3, multiwavelet2, multiwavelet3 };
inline constexpr LineBasis line_bases[] = {LineBasis::haar, LineBasis::flatlet2, LineBasis::flatlet3,
                                           LineBasis::multiwavelet2, LineBasis::multiwavelet3};
std::string_view name_of(LineBasis basis);

/// One step between levels: the 2k coefficients of two adjacent intervals become k coefficients of the combined
/// interval, and k details that vanish for polynomials of degree below k. Source: [Gortler93], multiwavelets after
/// [Alpert93].
///
/// Multiwavelets are orthonormal: Legendre polynomials on every interval, and the orthogonal complement. Flatlets are k
/// boxes per interval. Their analysis functions are piecewise constant; the synthesis functions follow by inversion.
/// Smooth kernels have small details in both.
class TwoScaleStep {
  public:
    explicit TwoScaleStep(LineBasis basis);

    std::size_t order() const { return k_; }  ///< k
    bool is_orthonormal() const { return orthonormal_; }
    /// `fine`: 2k values; `out`: k coarse ones, then k details.
    void analyse(const double* fine, double* out) const { multiply(analysis_, fine, out); }
    void synthesise(const double* coarse_and_details, double* fine) const {
        multiply(synthesis_, coarse_and_details, fine);
    }

  private:
    void multiply(const std::vector<double>& matrix, const double* in, double* out) const;

    std::size_t k_;
    bool orthonormal_;
    std::vector<double> analysis_, synthesis_;  ///< 2k x 2k, row by row.
};

/// Values of the k orthonormal functions of an interval of length `width` at relative position s in [0, 1].
std::vector<double> values_on_interval(LineBasis basis, double s, double width);

}  // namespace exitance::flatland
