#include "exitance/solve/relaxation.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// A reciprocal system of form factors between elements of different areas: A_i F_ij = A_j F_ji, row sums below 1.
class SmallTransport final : public TransportOperator {
  public:
    explicit SmallTransport(std::size_t n) : n_(n), F_(n * n), area_(n) {
        RandomStream random(7, Stream::mesh);
        for (double& a : area_) a = 0.5 + random.uniform();
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const double exchange = random.uniform() / static_cast<double>(2 * n);
                F_[i * n + j] = exchange / area_[i];
                F_[j * n + i] = exchange / area_[j];
            }
    }
    std::size_t size() const override { return n_; }
    Spectrum gather_at(std::size_t i, std::span<const Spectrum> b) const override {
        Spectrum sum;
        for (std::size_t j = 0; j < n_; ++j) sum += F_[i * n_ + j] * b[j];
        return sum;
    }
    void gather(std::span<const Spectrum> b, std::span<Spectrum> E) const override {
        for (std::size_t i = 0; i < n_; ++i) E[i] = gather_at(i, b);
    }
    std::size_t memory_bytes() const override { return 8 * F_.size(); }
    const std::vector<double>& area() const { return area_; }

  private:
    std::size_t n_;
    std::vector<double> F_, area_;
};

struct Problem {
    SmallTransport F{60};
    std::vector<Spectrum> rho, rhs;
    Problem() {
        RandomStream random(8, Stream::mesh);
        for (std::size_t i = 0; i < F.size(); ++i) {
            Spectrum r, e;
            for (std::size_t b = 0; b < bands; ++b) r[b] = 0.95 * random.uniform(), e[b] = random.uniform();
            rho.push_back(i % 7 == 0 ? Spectrum() : r);  // some black elements
            rhs.push_back(i % 5 == 0 ? Spectrum() : e);
        }
    }
    RadiositySystem system() const { return {F, rho, rhs, F.area()}; }
};

class EveryRelaxation : public testing::TestWithParam<Relaxation> {};
INSTANTIATE_TEST_SUITE_P(Relaxations, EveryRelaxation,
                         testing::Values(Relaxation::jacobi, Relaxation::gauss_seidel, Relaxation::cg,
                                         Relaxation::gmres, Relaxation::chebyshev));

TEST_P(EveryRelaxation, ReachesTheRequestedResidual) {
    const Problem problem;
    std::vector<Spectrum> b(problem.F.size()), E(problem.F.size());
    const SolveReport report = solve_radiosity(problem.system(), GetParam(), b, {.residual = 1e-10});
    EXPECT_TRUE(report.converged);
    problem.F.gather(b, E);
    for (std::size_t i = 0; i < b.size(); ++i)
        // The rule bounds the norm of 60 residuals of size about 1 by 1e-10 of that of the right-hand side.
        EXPECT_LT(max(problem.rhs[i] + problem.rho[i] * E[i] - b[i]), 2e-9);
}

TEST_P(EveryRelaxation, ReportsThatItRanOutOfIterations) {
    const Problem problem;
    std::vector<Spectrum> b(problem.F.size());
    const SolveReport report =
        solve_radiosity(problem.system(), GetParam(), b, {.residual = 1e-14, .max_iterations = 2});
    EXPECT_FALSE(report.converged);
    EXPECT_GT(report.residual, 1e-14);
}

TEST(Relaxation, KrylovNeedsFewerGathersThanJacobi) {
    const Problem problem;
    const auto gathers = [&](Relaxation method) {
        std::vector<Spectrum> b(problem.F.size());
        return solve_radiosity(problem.system(), method, b, {.residual = 1e-10}).iterations;
    };
    EXPECT_LT(gathers(Relaxation::cg), gathers(Relaxation::jacobi));
    EXPECT_LT(gathers(Relaxation::gmres), gathers(Relaxation::jacobi));
}

/// Two plates of equal elements that see only each other: F has the eigenvalues 1 and -1.
class TwoPlates final : public TransportOperator {
  public:
    std::size_t size() const override { return 8; }
    Spectrum gather_at(std::size_t i, std::span<const Spectrum> b) const override {
        Spectrum sum;
        for (std::size_t j = 0; j < 4; ++j) sum += 0.25 * b[i < 4 ? 4 + j : j];
        return sum;
    }
    void gather(std::span<const Spectrum> b, std::span<Spectrum> E) const override {
        for (std::size_t i = 0; i < size(); ++i) E[i] = gather_at(i, b);
    }
    std::size_t memory_bytes() const override { return 0; }
};

TEST(Relaxation, ChebyshevNeedsFarFewerGathersThanJacobiAtHighReflectance) {
    const TwoPlates F;
    const std::vector<Spectrum> rho(F.size(), Spectrum(0.95));
    std::vector<Spectrum> rhs(F.size());
    rhs[0] = Spectrum(1.0);
    const std::vector<double> area(F.size(), 1.0);
    const auto gathers = [&](Relaxation method) {
        std::vector<Spectrum> b(F.size());
        const SolveReport report = solve_radiosity({F, rho, rhs, area}, method, b, {.residual = 1e-8});
        EXPECT_TRUE(report.converged);
        return report.iterations;
    };
    // Jacobi: ln 1e-8 / ln 0.95 = 359, less because only one element sends light at first. Chebyshev converges by (1 -
    // (1 - r^2)^(1/2)) / r = 0.72 per step instead of r = 0.95: 57 steps.
    EXPECT_NEAR(static_cast<double>(gathers(Relaxation::jacobi)), 359, 15);
    EXPECT_LE(gathers(Relaxation::chebyshev), 65u);
}

/// Elements in a ring; each receives all light of the previous one. Krylov spaces of few dimensions do not contain
/// light that has travelled around the ring.
class Ring final : public TransportOperator {
  public:
    std::size_t size() const override { return 64; }
    Spectrum gather_at(std::size_t i, std::span<const Spectrum> b) const override {
        return b[(i + size() - 1) % size()];
    }
    void gather(std::span<const Spectrum> b, std::span<Spectrum> E) const override {
        for (std::size_t i = 0; i < size(); ++i) E[i] = gather_at(i, b);
    }
    std::size_t memory_bytes() const override { return 0; }
};

TEST(Relaxation, GmresConvergesAcrossRestarts) {
    const Ring F;
    Spectrum even;
    for (std::size_t k = 0; k < bands; ++k) even[k] = 0.9 - 0.2 * static_cast<double>(k);
    const std::vector<Spectrum> rho(F.size(), even);
    std::vector<Spectrum> rhs(F.size()), b(F.size());
    rhs[0] = Spectrum(1.0);
    const std::vector<double> area(F.size(), 1.0);
    const SolveReport report = solve_radiosity({F, rho, rhs, area}, Relaxation::gmres, b, {.residual = 1e-10});
    EXPECT_TRUE(report.converged);
    EXPECT_GT(report.iterations, 40u) << "light has to come round twice";
    for (std::size_t i = 0; i < F.size(); ++i)
        for (std::size_t k = 0; k < bands; ++k)
            EXPECT_NEAR(b[i][k], std::pow(even[k], i) / (1 - std::pow(even[k], F.size())), 1e-9);
}

TEST(Relaxation, AStopRequestEndsIt) {
    const Problem problem;
    StopRequest stop;
    stop.interrupt();
    std::vector<Spectrum> b(problem.F.size());
    const SolveReport report =
        solve_radiosity(problem.system(), Relaxation::jacobi, b, {.residual = 0, .request = &stop});
    EXPECT_TRUE(report.interrupted);
    EXPECT_EQ(report.iterations, 1u);
}

}  // namespace
}  // namespace exitance
