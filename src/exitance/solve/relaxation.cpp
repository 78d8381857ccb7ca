#include "exitance/solve/relaxation.hpp"

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/solve/gmres.hpp"
#include "exitance/solve/relaxation_watch.hpp"

namespace exitance {
namespace {

Spectrum divided(const Spectrum& x, const Spectrum& y) {
    Spectrum out;
    for (std::size_t k = 0; k < bands; ++k) out[k] = y[k] != 0 ? x[k] / y[k] : 0;
    return out;
}

/// rhs + rho F b - b
void residual(const RadiositySystem& s, std::span<const Spectrum> b, Values& r) {
    r.resize(b.size());
    s.F.gather_own(b, r);
    s.F.dealt().for_each_own([&](std::size_t i) { r[i] = s.rhs[i] + s.reflectance[i] * r[i] - b[i]; });
}

SolveReport jacobi(const RadiositySystem& s, std::span<Spectrum> b, StopRule stop) {
    RelaxationWatch watch(s, stop);
    Values r;
    for (;;) {
        residual(s, b, r);
        ++watch.report.iterations;
        const bool done = watch.done(r);
        // The residual is the change of one more sweep, so it is applied even after the last test.
        watch.vectors.dealt.for_each_own([&](std::size_t i) { b[i] += r[i]; });
        if (done) return watch.report;
    }
}

/// Upper bound on the eigenvalues of rho F, per band: the largest (rho F x)_i / x_i for x = rho F 1 [Wielandt50]. Valid
/// if F has no negative entries. Two gathers.
Spectrum spectral_bound(const RadiositySystem& s) {
    Values x(s.rhs.size(), Spectrum(1.0)), y(x.size());
    Spectrum bound(0.0);
    for (int step = 0; step < 2; ++step) {
        s.F.gather_own(x, y);
        bound = Spectrum(0.0);
        for (std::size_t i = 0; i < x.size(); ++i) {
            y[i] = s.reflectance[i] * y[i];
            const Spectrum ratio = divided(y[i], x[i]);
            for (std::size_t k = 0; k < bands; ++k) bound[k] = std::max(bound[k], ratio[k]);
        }
        if (s.F.dealt().is_spread())
            for (double& v : bound.value) v = largest_of_all(v);
        std::swap(x, y);
    }
    for (double& v : bound.value) v = std::min(v, 0.9999);
    return bound;
}

SolveReport chebyshev(const RadiositySystem& s, std::span<Spectrum> b, StopRule stop) {
    RelaxationWatch watch(s, stop);
    Spectrum r = spectral_bound(s), omega;
    watch.report.iterations += 2;
    Values before(b.begin(), b.end()), change;
    double least = HUGE_VAL;
    for (int step = 0;; ++step) {
        residual(s, b, change);
        ++watch.report.iterations;
        const bool done = watch.done(change);
        constexpr double diverges = 10;
        if (watch.report.residual > diverges * least) {  // negative entries of F made the bound invalid
            for (double& v : r.value) v = 0.5 * (v + 1);
            step = 0;
        }
        least = std::min(least, watch.report.residual);
        for (std::size_t k = 0; k < bands; ++k)
            omega[k] = done || step == 0 ? 1
                       : step == 1       ? 2 / (2 - r[k] * r[k])
                                         : 1 / (1 - 0.25 * r[k] * r[k] * omega[k]);
        watch.vectors.dealt.for_each_own([&](std::size_t i) {
            const Spectrum now = b[i];
            b[i] = before[i] + omega * (now + change[i] - before[i]);
            before[i] = now;
        });
        if (done) return watch.report;
    }
}

SolveReport gauss_seidel(const RadiositySystem& s, std::span<Spectrum> b, StopRule stop) {
    RelaxationWatch watch(s, stop);
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

SolveReport conjugate_gradients(const RadiositySystem& s, std::span<Spectrum> b, StopRule stop) {
    const std::size_t n = b.size();
    RelaxationWatch watch(s, stop);
    Values r, p(n), q(n);
    // b is known for black elements. For the others the residual of the symmetric form is A r / rho, and its Jacobi
    // preconditioner is rho / A (1 - rho F_ii) with F_ii = 0. Hence z = r, and inner products have the weight A / rho.
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < bands; ++k)
            if (s.reflectance[i][k] == 0) b[i][k] = s.rhs[i][k];
    const auto for_each = [&](const auto& body) { watch.vectors.dealt.for_each_own(body); };
    const auto weighted = [&](std::span<const Spectrum> x, std::span<const Spectrum> y) {
        return watch.vectors.dealt.sum<Spectrum>(
            [&](std::size_t i) { return s.area[i] * divided(x[i] * y[i], s.reflectance[i]); });
    };
    residual(s, b, r);
    ++watch.report.iterations;
    if (watch.done(r)) return watch.report;
    p = r;
    Spectrum rr = weighted(r, r);
    for (;;) {
        s.F.gather_own(p, q);
        ++watch.report.iterations;
        for_each([&](std::size_t i) { q[i] = p[i] - s.reflectance[i] * q[i]; });
        const Spectrum alpha = divided(rr, weighted(p, q));
        for_each([&](std::size_t i) { b[i] += alpha * p[i], r[i] += -1.0 * alpha * q[i]; });
        if (watch.done(r)) return watch.report;
        const Spectrum next = weighted(r, r);
        const Spectrum beta = divided(next, rr);
        rr = next;
        for_each([&](std::size_t i) { p[i] = r[i] + beta * p[i]; });
    }
}

}  // namespace

double surface_norm(std::span<const Spectrum> b, std::span<const double> area) {
    return std::sqrt(parallel_sum<double>(b.size(), [&](std::size_t i) { return area[i] * squared(b[i]); }));
}

namespace {

SolveReport relax(const RadiositySystem& system, Relaxation method, std::span<Spectrum> b, StopRule stop) {
    switch (method) {
        case Relaxation::jacobi:
            return jacobi(system, b, stop);
        case Relaxation::southwell:
        case Relaxation::gauss_seidel:
            return gauss_seidel(system, b, stop);
        case Relaxation::cg:
            return conjugate_gradients(system, b, stop);
        case Relaxation::gmres:
            return system.F.dealt().is_spread() ? gmres_over_processes(system, b, stop) : gmres(system, b, stop);
        case Relaxation::chebyshev:
            return chebyshev(system, b, stop);
    }
    return {};
}

}  // namespace

SolveReport solve_radiosity(const RadiositySystem& system, Relaxation method, std::span<Spectrum> b, StopRule stop) {
    const DealtUnknowns dealt = system.F.dealt();
    if (!dealt.is_spread()) return relax(system, method, b, stop);
    const Values rho = dealt.own_part(system.reflectance), rhs = dealt.own_part(system.rhs);
    const std::vector<double> area = dealt.own_part(system.area);
    Values own = dealt.own_part<Spectrum>(b);
    const SolveReport report = relax({system.F, rho, rhs, area}, method, own, stop);
    dealt.tell<Spectrum>(own, b, "solve");
    return report;
}

}  // namespace exitance
