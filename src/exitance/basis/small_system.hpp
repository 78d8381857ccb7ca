#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace exitance {

/// Solves A X = B by Cholesky decomposition. A is n x n, symmetric and positive definite, B is n x m, both row-major; X
/// replaces B, and A is overwritten.
inline void solve_in_place(std::vector<double>& A, std::vector<double>& B, std::size_t n, std::size_t m) {
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t j = 0; j < k; ++j)
            for (std::size_t i = k; i < n; ++i) A[i * n + k] -= A[i * n + j] * A[k * n + j];
        const double pivot = std::sqrt(A[k * n + k]);
        for (std::size_t i = k; i < n; ++i) A[i * n + k] /= pivot;
    }
    for (std::size_t c = 0; c < m; ++c) {
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < i; ++j) B[i * m + c] -= A[i * n + j] * B[j * m + c];
            B[i * m + c] /= A[i * n + i];
        }
        for (std::size_t i = n; i-- > 0;) {
            for (std::size_t j = i + 1; j < n; ++j) B[i * m + c] -= A[j * n + i] * B[j * m + c];
            B[i * m + c] /= A[i * n + i];
        }
    }
}

}  // namespace exitance
