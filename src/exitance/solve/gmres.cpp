#include "exitance/solve/gmres.hpp"

#include <array>
#include <cmath>

#include "exitance/solve/relaxation_watch.hpp"

namespace exitance {
namespace {

/// GMRES's small least-squares problem, kept triangular by Givens rotations. The order of operations is that of PETSc,
/// so that both give the same bits.
struct Hessenberg {
    double H[gmres_restart + 1][gmres_restart] = {}, cosine[gmres_restart] = {}, sine[gmres_restart] = {},
                             g[gmres_restart + 1] = {};

    /// Adds column k (entries 0..k+1 must be set) to the triangle; returns the norm of the residual.
    double rotate(int k) {
        for (int i = 0; i < k; ++i) {
            const double h = H[i][k];
            H[i][k] = cosine[i] * h + sine[i] * H[i + 1][k];
            H[i + 1][k] = cosine[i] * H[i + 1][k] - sine[i] * h;
        }
        const double length = std::sqrt(H[k][k] * H[k][k] + H[k + 1][k] * H[k + 1][k]);
        cosine[k] = length > 0 ? H[k][k] / length : 1;
        sine[k] = length > 0 ? H[k + 1][k] / length : 0;
        g[k + 1] = -(sine[k] * g[k]);
        g[k] = cosine[k] * g[k];
        H[k][k] = cosine[k] * H[k][k] + sine[k] * H[k + 1][k];
        return std::abs(g[k + 1]);
    }

    /// Coefficients of the first `size` basis vectors.
    std::vector<double> solve(int size) const {
        std::vector<double> y(static_cast<std::size_t>(size));
        for (int i = size - 1; i >= 0; --i) {
            double sum = g[i];
            for (int j = i + 1; j < size; ++j) sum = sum - H[i][j] * y[static_cast<std::size_t>(j)];
            y[static_cast<std::size_t>(i)] = H[i][i] != 0 ? sum / H[i][i] : 0;
        }
        return y;
    }
};

/// Scales x to length 1 unless it is 0; returns its previous length.
double normalise(const KrylovVectors& vectors, std::span<Spectrum> x) {
    const double length = vectors.norm(x);
    if (length > 0) vectors.multiply(x, 1 / length);
    return length;
}

/// rhs - A b
void residual(const RadiositySystem& system, std::span<const Spectrum> b, std::span<Spectrum> r) {
    Values product(b.size());
    apply_system(system, b, product);
    system.F.dealt().for_each_own([&](std::size_t i) { r[i] = system.rhs[i] - product[i]; });
}

}  // namespace

void apply_system(const RadiositySystem& system, std::span<const Spectrum> b, std::span<Spectrum> out) {
    system.F.gather_own(b, out);
    system.F.dealt().for_each_own([&](std::size_t i) { out[i] = b[i] - system.reflectance[i] * out[i]; });
}

SolveReport gmres(const RadiositySystem& system, std::span<Spectrum> b, StopRule stop) {
    RelaxationWatch watch(system, stop);
    for (bool done = false; !done;) {
        std::vector<Values> basis(1, Values(b.size()));
        residual(system, b, basis.front());
        ++watch.report.iterations;
        Hessenberg small;
        small.g[0] = normalise(watch.vectors, basis.front());
        done = watch.done(small.g[0]);
        std::vector<std::span<const Spectrum>> known;
        for (int k = 0; k < gmres_restart && !done; ++k) {
            known.emplace_back(basis.back());
            Values w(b.size());
            apply_system(system, basis.back(), w);
            ++watch.report.iterations;
            std::vector<double> products = watch.vectors.products(w, known);
            for (int j = 0; j <= k; ++j) {
                small.H[j][k] = products[static_cast<std::size_t>(j)];
                products[static_cast<std::size_t>(j)] *= -1;
            }
            watch.vectors.add_combination(w, products, known);
            small.H[k + 1][k] = normalise(watch.vectors, w);
            done = watch.done(small.rotate(k));
            basis.push_back(std::move(w));
        }
        if (known.empty()) break;
        Values change(b.size());
        watch.vectors.add_combination(change, small.solve(static_cast<int>(known.size())), known);
        watch.vectors.dealt.for_each_own([&](std::size_t i) { b[i] += change[i]; });
    }
    return watch.report;
}

}  // namespace exitance
