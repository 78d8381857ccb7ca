#include "exitance/lab/growing_cells/least_squares.hpp"

#include <cmath>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

constexpr std::size_t batch = 4096;  ///< Rows made in parallel before they are summed in order.
constexpr double relative_residual = 1e-9;

double product(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

void multiply(const std::vector<double>& A, const std::vector<double>& x, std::vector<double>& out) {
    const std::size_t n = x.size();
    parallel_for(n, 64, [&](std::size_t i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += A[i * n + j] * x[j];
        out[i] = sum;
    });
}

}  // namespace

void solve_positive(const std::vector<double>& A, const std::vector<double>& b, std::vector<double>& x,
                    std::size_t steps) {
    const std::size_t n = b.size();
    std::vector<double> r(n), z(n), p(n), Ap(n), inverse(n);
    for (std::size_t i = 0; i < n; ++i) inverse[i] = A[i * n + i] > 0 ? 1 / A[i * n + i] : 1;
    multiply(A, x, r);
    for (std::size_t i = 0; i < n; ++i) r[i] = b[i] - r[i], z[i] = inverse[i] * r[i];
    p = z;
    double rz = product(r, z);
    const double limit = relative_residual * std::sqrt(product(b, b));
    for (std::size_t step = 0; step < steps && std::sqrt(product(r, r)) > limit; ++step) {
        multiply(A, p, Ap);
        const double curvature = product(p, Ap);
        if (!(curvature > 0)) return;
        const double along = rz / curvature;
        for (std::size_t i = 0; i < n; ++i) x[i] += along * p[i], r[i] -= along * Ap[i], z[i] = inverse[i] * r[i];
        const double next = product(r, z);
        for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + next / rz * p[i];
        rz = next;
    }
}

void fit_least_squares(const FitProblem& problem, std::vector<double>& values) {
    const std::size_t n = problem.unknowns, m = problem.outputs;
    std::vector<double> A(n * n), b(n * m);
    std::vector<FitRow> rows(std::min(batch, problem.samples)), of_unknown(n);
    for (std::size_t first = 0; first < problem.samples; first += batch) {
        const std::size_t count = std::min(batch, problem.samples - first);
        parallel_for(count, 64, [&](std::size_t i) { rows[i].clear(), problem.row(first + i, rows[i]); });
        // Each unknown's row of the sums belongs to one task, which adds samples in order.
        for (auto& list : of_unknown) list.clear();
        for (std::size_t s = 0; s < count; ++s)
            for (const auto& [c, weight] : rows[s])
                of_unknown[c].emplace_back(static_cast<std::uint32_t>(s), weight * problem.weight(first + s));
        parallel_for(n, 8, [&](std::size_t c) {
            for (const auto& [s, scaled] : of_unknown[c]) {
                for (const auto& [other, w] : rows[s]) A[c * n + other] += scaled * w;
                for (std::size_t k = 0; k < m; ++k) b[c * m + k] += scaled * problem.target(first + s, k);
            }
        });
    }
    double mean = 0;
    for (std::size_t i = 0; i < n; ++i) mean += A[i * n + i] / static_cast<double>(n);
    const double ridge = problem.ridge * mean;
    if (!(ridge > 0)) return;  // no sample affects any unknown
    for (std::size_t i = 0; i < n; ++i) {
        A[i * n + i] += ridge;
        for (std::size_t k = 0; k < m; ++k) b[i * m + k] += ridge * values[i * m + k];
    }
    std::vector<double> x(n), rhs(n);
    for (std::size_t k = 0; k < m; ++k) {
        for (std::size_t i = 0; i < n; ++i) x[i] = values[i * m + k], rhs[i] = b[i * m + k];
        solve_positive(A, rhs, x, problem.steps);
        for (std::size_t i = 0; i < n; ++i) values[i * m + k] = x[i];
    }
}

}  // namespace exitance
