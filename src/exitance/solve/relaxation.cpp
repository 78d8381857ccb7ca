#include "exitance/solve/relaxation.hpp"

#include <cmath>

#include "exitance/core/parallel.hpp"

namespace exitance {
namespace {

using Values = std::vector<Spectrum>;

/// body(i) for every unknown.
template <class Body>
void for_each(std::size_t n, const Body& body) {
    parallel_for(n, 1024, body);
}

/// One inner product a band, in blocks of fixed length: the same bits on any number of threads.
Spectrum inner(std::span<const Spectrum> x, std::span<const Spectrum> y, std::span<const double> weight) {
    return parallel_sum<Spectrum>(x.size(), [&](std::size_t i) { return weight[i] * (x[i] * y[i]); });
}

Spectrum divided(const Spectrum& x, const Spectrum& y) {
    Spectrum out;
    for (std::size_t k = 0; k < bands; ++k) out[k] = y[k] != 0 ? x[k] / y[k] : 0;
    return out;
}

Spectrum root(const Spectrum& x) {
    Spectrum out;
    for (std::size_t k = 0; k < bands; ++k) out[k] = std::sqrt(std::max(0.0, x[k]));
    return out;
}

/// rhs + rho F b - b
void residual(const RadiositySystem& s, std::span<const Spectrum> b, Values& r) {
    r.resize(b.size());
    s.F.gather(b, r);
    for_each(b.size(), [&](std::size_t i) { r[i] = s.rhs[i] + s.reflectance[i] * r[i] - b[i]; });
}

/// What every relaxation shares: the norm to reach, and the count of gathers.
class Watch {
  public:
    Watch(const RadiositySystem& s, StopRule stop) : stop_(stop), scale_(surface_norm(s.rhs, s.area)), area_(s.area) {}

    /// One more application of F has left the residual `r`; is it time to stop?
    bool done(std::span<const Spectrum> r) { return done(surface_norm(r, area_)); }
    bool done(double residual_norm) {
        report.residual = scale_ > 0 ? residual_norm / scale_ : 0;
        report.converged = report.residual <= stop_.residual;
        report.interrupted = !report.converged && stop_.request && stop_.request->requested();
        return report.converged || report.interrupted || report.iterations >= stop_.max_iterations;
    }

    SolveReport report;

  private:
    StopRule stop_;
    double scale_;
    std::span<const double> area_;
};

SolveReport jacobi(const RadiositySystem& s, std::span<Spectrum> b, StopRule stop) {
    Watch watch(s, stop);
    Values r;
    for (;;) {
        residual(s, b, r);
        ++watch.report.iterations;
        const bool done = watch.done(r);
        // The residual is the change that one more sweep makes: it is taken along even when it is the last.
        for (std::size_t i = 0; i < b.size(); ++i) b[i] += r[i];
        if (done) return watch.report;
    }
}

/// A bound on the eigenvalues of rho F, a band: the largest (rho F x)_i / x_i for x = rho F 1 [Wielandt50], which
/// holds where F has no negative entries. Two gathers.
Spectrum spectral_bound(const RadiositySystem& s) {
    Values x(s.rhs.size(), Spectrum(1.0)), y(x.size());
    Spectrum bound(0.0);
    for (int step = 0; step < 2; ++step) {
        s.F.gather(x, y);
        bound = Spectrum(0.0);
        for (std::size_t i = 0; i < x.size(); ++i) {
            y[i] = s.reflectance[i] * y[i];
            const Spectrum ratio = divided(y[i], x[i]);
            for (std::size_t k = 0; k < bands; ++k) bound[k] = std::max(bound[k], ratio[k]);
        }
        std::swap(x, y);
    }
    for (double& v : bound.value) v = std::min(v, 0.9999);
    return bound;
}

SolveReport chebyshev(const RadiositySystem& s, std::span<Spectrum> b, StopRule stop) {
    Watch watch(s, stop);
    Spectrum r = spectral_bound(s), omega;
    watch.report.iterations += 2;
    Values before(b.begin(), b.end()), change;
    double least = HUGE_VAL;
    for (int step = 0;; ++step) {
        residual(s, b, change);
        ++watch.report.iterations;
        const bool done = watch.done(change);
        constexpr double diverges = 10;
        if (watch.report.residual > diverges * least) {  // the bound was none: entries below 0
            for (double& v : r.value) v = 0.5 * (v + 1);
            step = 0;
        }
        least = std::min(least, watch.report.residual);
        for (std::size_t k = 0; k < bands; ++k)
            omega[k] = done || step == 0 ? 1
                       : step == 1       ? 2 / (2 - r[k] * r[k])
                                         : 1 / (1 - 0.25 * r[k] * r[k] * omega[k]);
        parallel_for(b.size(), 1024, [&](std::size_t i) {
            const Spectrum now = b[i];
            b[i] = before[i] + omega * (now + change[i] - before[i]);
            before[i] = now;
        });
        if (done) return watch.report;
    }
}

SolveReport gauss_seidel(const RadiositySystem& s, std::span<Spectrum> b, StopRule stop) {
    Watch watch(s, stop);
    for (;;) {
        double change = 0;
        for (std::size_t i = 0; i < b.size(); ++i) {
            const Spectrum fresh = s.rhs[i] + s.reflectance[i] * s.F.gather_at(i, b);
            change += s.area[i] * squared(fresh - b[i]);
            b[i] = fresh;
        }
        ++watch.report.iterations;
        if (watch.done(std::sqrt(change))) return watch.report;
    }
}

/// x <- x + scale p, a factor a band.
void add_scaled(std::span<Spectrum> x, const Spectrum& scale, std::span<const Spectrum> p) {
    for_each(x.size(), [&](std::size_t i) { x[i] += scale * p[i]; });
}

SolveReport conjugate_gradients(const RadiositySystem& s, std::span<Spectrum> b, StopRule stop) {
    const std::size_t n = b.size();
    Watch watch(s, stop);
    Values r, p(n), z(n), q(n);
    // Rows of black elements are solved at once; for the others the residual of the symmetric form is A r / rho, and
    // its Jacobi preconditioner rho / A (1 - rho F_ii), F_ii = 0: so z = r, and the products carry the weight A / rho.
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < bands; ++k)
            if (s.reflectance[i][k] == 0) b[i][k] = s.rhs[i][k];
    const auto weighted = [&](std::span<const Spectrum> x, std::span<const Spectrum> y) {
        return parallel_sum<Spectrum>(
            n, [&](std::size_t i) { return s.area[i] * divided(x[i] * y[i], s.reflectance[i]); });
    };
    residual(s, b, r);
    ++watch.report.iterations;
    if (watch.done(r)) return watch.report;
    p = r;
    Spectrum rr = weighted(r, r);
    for (;;) {
        s.F.gather(p, q);
        ++watch.report.iterations;
        for (std::size_t i = 0; i < n; ++i) q[i] = p[i] - s.reflectance[i] * q[i];
        const Spectrum alpha = divided(rr, weighted(p, q));
        add_scaled(b, alpha, p);
        add_scaled(r, -1.0 * alpha, q);
        if (watch.done(r)) return watch.report;
        const Spectrum next = weighted(r, r);
        const Spectrum beta = divided(next, rr);
        rr = next;
        for (std::size_t i = 0; i < n; ++i) p[i] = r[i] + beta * p[i];
    }
}

/// GMRES's small least-squares problem, one a band, kept triangular by Givens rotations.
struct Hessenberg {
    static constexpr int restart = 20;
    double H[restart + 1][restart] = {}, cosine[restart] = {}, sine[restart] = {}, g[restart + 1] = {};

    /// Takes column k (entries 0..k+1 filled in) into the triangle; returns the size of the residual.
    double rotate(int k) {
        for (int i = 0; i < k; ++i) {
            const double h = cosine[i] * H[i][k] + sine[i] * H[i + 1][k];
            H[i + 1][k] = -sine[i] * H[i][k] + cosine[i] * H[i + 1][k];
            H[i][k] = h;
        }
        const double length = std::hypot(H[k][k], H[k + 1][k]);
        cosine[k] = length > 0 ? H[k][k] / length : 1;
        sine[k] = length > 0 ? H[k + 1][k] / length : 0;
        H[k][k] = length;
        H[k + 1][k] = 0;
        g[k + 1] = -sine[k] * g[k];
        g[k] *= cosine[k];
        return std::abs(g[k + 1]);
    }

    /// Coefficients of the first `size` basis vectors.
    std::array<double, restart> solve(int size) const {
        std::array<double, restart> y{};
        for (int i = size - 1; i >= 0; --i) {
            double sum = g[i];
            for (int j = i + 1; j < size; ++j) sum -= H[i][j] * y[static_cast<std::size_t>(j)];
            y[static_cast<std::size_t>(i)] = H[i][i] != 0 ? sum / H[i][i] : 0;
        }
        return y;
    }
};

SolveReport gmres(const RadiositySystem& s, std::span<Spectrum> b, StopRule stop) {
    const std::size_t n = b.size();
    Watch watch(s, stop);
    Values r;
    for (;;) {
        residual(s, b, r);
        ++watch.report.iterations;
        if (watch.done(r)) return watch.report;
        std::array<Hessenberg, bands> small;
        std::vector<Values> basis(1, Values(n));
        const Spectrum length = root(inner(r, r, s.area));
        for_each(n, [&](std::size_t i) { basis[0][i] = divided(r[i], length); });
        for (std::size_t band = 0; band < bands; ++band) small[band].g[0] = length[band];
        int k = 0;
        for (bool done = false; k < Hessenberg::restart && !done; ++k) {
            Values w(n);
            s.F.gather(basis.back(), w);
            ++watch.report.iterations;
            for_each(n, [&](std::size_t i) { w[i] = basis.back()[i] - s.reflectance[i] * w[i]; });
            for (int j = 0; j <= k; ++j) {
                const Values& v = basis[static_cast<std::size_t>(j)];
                const Spectrum h = inner(w, v, s.area);
                add_scaled(w, -1.0 * h, v);
                for (std::size_t band = 0; band < bands; ++band) small[band].H[j][k] = h[band];
            }
            const Spectrum h = root(inner(w, w, s.area));
            double squares = 0;
            for (std::size_t band = 0; band < bands; ++band) {
                small[band].H[k + 1][k] = h[band];
                squares += std::pow(small[band].rotate(k), 2);
            }
            for_each(n, [&](std::size_t i) { w[i] = divided(w[i], h); });
            basis.push_back(std::move(w));
            done = watch.done(std::sqrt(squares));
        }
        for (std::size_t band = 0; band < bands; ++band) {
            const auto y = small[band].solve(k);
            for_each(n, [&](std::size_t i) {
                for (int j = 0; j < k; ++j)
                    b[i][band] += y[static_cast<std::size_t>(j)] * basis[static_cast<std::size_t>(j)][i][band];
            });
        }
        if (watch.report.converged || watch.report.interrupted || watch.report.iterations >= stop.max_iterations)
            return watch.report;
    }
}

}  // namespace

double surface_norm(std::span<const Spectrum> b, std::span<const double> area) {
    return std::sqrt(parallel_sum<double>(b.size(), [&](std::size_t i) { return area[i] * squared(b[i]); }));
}

SolveReport solve_radiosity(const RadiositySystem& system, Relaxation method, std::span<Spectrum> b, StopRule stop) {
    switch (method) {
        case Relaxation::jacobi:
            return jacobi(system, b, stop);
        case Relaxation::southwell:
        case Relaxation::gauss_seidel:
            return gauss_seidel(system, b, stop);
        case Relaxation::cg:
            return conjugate_gradients(system, b, stop);
        case Relaxation::gmres:
            return gmres(system, b, stop);
        case Relaxation::chebyshev:
            return chebyshev(system, b, stop);
    }
    return {};
}

}  // namespace exitance
