#include "exitance/solve/dense_relaxation.hpp"

#include <cmath>
#include <numeric>

#include "exitance/base/parallel.hpp"
#include "exitance/solve/growth_watch.hpp"

namespace exitance {
namespace {

std::vector<Spectrum> residual_of(const RadiositySystem& s, std::span<const Spectrum> b) {
    std::vector<Spectrum> r(b.size());
    s.F.gather(b, r);
    for (std::size_t i = 0; i < b.size(); ++i) r[i] = s.rhs[i] + s.reflectance[i] * r[i] - b[i];
    return r;
}

/// Repeats sweeps until a criterion of the rule is met or the residual diverges.
template <class Sweep>
SolveReport sweep_until(const RadiositySystem& s, std::span<Spectrum> b, const StopRule& stop,
                        const std::function<void()>& swept, const Sweep& sweep) {
    SolveReport report;
    const double scale = surface_norm(s.rhs, s.area);
    if (scale == 0) return report.converged = true, report;
    while (report.iterations < stop.max_iterations) {
        sweep();
        ++report.iterations;
        if (swept) swept();
        report.residual = surface_norm(residual_of(s, b), s.area) / scale;
        report.converged = report.residual <= stop.residual;
        report.interrupted = !report.converged && stop.request && stop.request->requested();
        if (report.converged || report.interrupted || !(report.residual < diverged_residual)) break;
    }
    return report;
}

/// The entries of F, row by row. Each gather computes as many columns as there are bands.
std::vector<double> entries_of(const TransportOperator& F) {
    const std::size_t n = F.size();
    std::vector<double> out(n * n);
    std::vector<Spectrum> unit(n), column(n);
    for (std::size_t first = 0; first < n; first += bands) {
        const std::size_t count = std::min(bands, n - first);
        for (std::size_t k = 0; k < count; ++k) unit[first + k][k] = 1;
        F.gather(unit, column);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < count; ++k) out[i * n + first + k] = column[i][k];
        for (std::size_t k = 0; k < count; ++k) unit[first + k] = {};
    }
    return out;
}

/// Solves A x = rhs in place; x is the right-hand side, A is stored row by row and destroyed. Returns false on a stop
/// request.
bool eliminate(std::vector<double>& A, std::vector<double>& x, const StopRequest& stop) {
    const std::size_t n = x.size();
    for (std::size_t k = 0; k < n; ++k) {
        if (stop.requested()) return false;
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (std::abs(A[i * n + k]) > std::abs(A[pivot * n + k])) pivot = i;
        if (pivot != k) {
            std::swap_ranges(&A[k * n], &A[k * n] + n, &A[pivot * n]);
            std::swap(x[k], x[pivot]);
        }
        parallel_for(n - k - 1, 64, [&](std::size_t j) {
            const std::size_t i = k + 1 + j;
            const double factor = A[i * n + k] / A[k * n + k];
            if (factor == 0) return;
            for (std::size_t c = k + 1; c < n; ++c) A[i * n + c] -= factor * A[k * n + c];
            x[i] -= factor * x[k];
        });
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t c = k + 1; c < n; ++c) x[k] -= A[k * n + c] * x[c];
        x[k] /= A[k * n + k];
    }
    return true;
}

}  // namespace

SolveReport relax_at_once(const RadiositySystem& s, std::span<Spectrum> b, const StopRule& stop,
                          const std::function<void()>& swept) {
    return sweep_until(s, b, stop, swept, [&] {
        const std::vector<Spectrum> r = residual_of(s, b);
        for (std::size_t i = 0; i < b.size(); ++i) b[i] += r[i];
    });
}

SolveReport relax_in_turn(const RadiositySystem& s, double factor, std::span<Spectrum> b, const StopRule& stop,
                          const std::function<void()>& swept) {
    return sweep_until(s, b, stop, swept, [&] {
        for (std::size_t i = 0; i < b.size(); ++i)
            b[i] += factor * (s.rhs[i] + s.reflectance[i] * s.F.gather_at(i, b) - b[i]);
    });
}

SolveReport relax_largest_residual(const RadiositySystem& s, std::span<Spectrum> b, const StopRule& stop,
                                   const std::function<void()>& swept) {
    const std::size_t n = b.size();
    const std::vector<double> F = entries_of(s.F);
    std::vector<Spectrum> r = residual_of(s, b);
    return sweep_until(s, b, stop, swept, [&] {
        for (std::size_t step = 0; step < n; ++step) {
            std::size_t most = 0;
            double flux = -1;
            for (std::size_t i = 0; i < n; ++i)
                if (const double own = s.area[i] * std::sqrt(squared(r[i])); own > flux) flux = own, most = i;
            if (!(flux > 0)) return;
            const Spectrum sent = r[most];
            b[most] += sent;
            r[most] = {};
            for (std::size_t i = 0; i < n; ++i)
                if (const double f = F[i * n + most]; f != 0) r[i] += f * (s.reflectance[i] * sent);
        }
    });
}

SolveReport solve_dense(const RadiositySystem& s, std::span<Spectrum> b, const StopRequest& stop) {
    const std::size_t n = b.size();
    const std::vector<double> F = entries_of(s.F);
    for (std::size_t band = 0; band < bands; ++band) {
        std::vector<double> A(n * n), x(n);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j)
                A[i * n + j] = (i == j ? 1.0 : 0.0) - s.reflectance[i][band] * F[i * n + j];
            x[i] = s.rhs[i][band];
        }
        if (!eliminate(A, x, stop)) return {.interrupted = true};
        for (std::size_t i = 0; i < n; ++i) b[i][band] = x[i];
    }
    const double scale = surface_norm(s.rhs, s.area);
    return {.iterations = 1,
            .residual = scale > 0 ? surface_norm(residual_of(s, b), s.area) / scale : 0,
            .converged = true};
}

}  // namespace exitance
