#include "exitance/solve/growth_watch.hpp"

#include <gtest/gtest.h>

#include "exitance/solve/dense_relaxation.hpp"

namespace exitance {
namespace {

/// Every element receives `factor` times the mean radiosity of all.
class EvenTransport final : public TransportOperator {
  public:
    explicit EvenTransport(double factor) : factor_(factor) {}
    std::size_t size() const override { return 4; }
    void gather(std::span<const Spectrum> b, std::span<Spectrum> E) const override {
        for (std::size_t i = 0; i < size(); ++i) E[i] = gather_at(i, b);
    }
    Spectrum gather_at(std::size_t, std::span<const Spectrum> b) const override {
        Spectrum sum;
        for (const Spectrum& v : b) sum += (factor_ / static_cast<double>(size())) * v;
        return sum;
    }
    std::size_t memory_bytes() const override { return 0; }

  private:
    double factor_;
};

SolveReport relaxed(double factor, double sor) {
    const EvenTransport F(factor);
    const std::vector<Spectrum> rho(4, Spectrum(0.8)), rhs(4, Spectrum(1.0));
    const std::vector<double> area(4, 1.0);
    std::vector<Spectrum> b = rhs;
    const RadiositySystem system{F, rho, rhs, area};
    const StopRule stop{.residual = 1e-6, .max_iterations = 1000};
    return sor > 0 ? relax_in_turn(system, sor, b, stop, {}) : relax_at_once(system, b, stop, {});
}

TEST(GrowthWatch, IgnoresOneOrTwoRises) {
    GrowthWatch watch;
    for (const double flux : {1.0, 0.5, 0.6, 0.7, 0.3, 0.1, 0.2, 0.05}) EXPECT_FALSE(watch.grows(flux)) << flux;
}

TEST(GrowthWatch, DetectsSlowAndFastGrowth) {
    GrowthWatch slow;
    EXPECT_FALSE(slow.grows(1));
    EXPECT_FALSE(slow.grows(1.01));
    EXPECT_FALSE(slow.grows(1.02));
    EXPECT_TRUE(slow.grows(1.03));
    GrowthWatch fast;
    EXPECT_FALSE(fast.grows(1));
    EXPECT_TRUE(fast.grows(11));
    EXPECT_TRUE(GrowthWatch().grows(std::numeric_limits<double>::quiet_NaN()));
}

TEST(GrowthWatch, StopsARelaxationWhoseTransportCreatesLight) {
    for (const double sor : {0.0, 1.0, 1.3}) {
        const SolveReport settles = relaxed(1, sor), grows = relaxed(1.5, sor);  // row sums of rho F: 0.8 and 1.2
        EXPECT_TRUE(settles.converged) << sor;
        EXPECT_FALSE(has_diverged(settles)) << sor;
        EXPECT_TRUE(has_diverged(grows)) << sor;
        EXPECT_LT(grows.iterations, 100u) << sor;
    }
}

}  // namespace
}  // namespace exitance
