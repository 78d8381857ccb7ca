#include "exitance/solve/conserving_transport.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace exitance {
namespace {

/// Transport between elements of different areas in proportion to their areas. The scene is closed, but a share of the
/// light is lost.
class LeakyTransport final : public TransportOperator {
  public:
    explicit LeakyTransport(double lost) : lost_(lost), area_{1, 2, 0.5, 3} {
        for (double a : area_) total_ += a;
    }
    std::size_t size() const override { return area_.size(); }
    Spectrum gather_at(std::size_t, std::span<const Spectrum> b) const override {
        Spectrum sum;
        for (std::size_t j = 0; j < size(); ++j) sum += ((1 - lost_) * area_[j] / total_) * b[j];
        return sum;
    }
    void gather(std::span<const Spectrum> b, std::span<Spectrum> E) const override {
        for (std::size_t i = 0; i < size(); ++i) E[i] = gather_at(i, b);
    }
    std::size_t memory_bytes() const override { return 0; }
    const std::vector<double>& area() const { return area_; }

  private:
    double lost_, total_ = 0;
    std::vector<double> area_;
};

/// Absorbed power as a share of the power of `first`.
double absorbed(const LeakyTransport& leaky, bool closed) {
    const std::vector<Spectrum> rho(4, Spectrum(0.9)), first = {Spectrum(1.0), Spectrum(), Spectrum(0.3), Spectrum()};
    std::vector<Spectrum> b = first, E(4);
    ConservingTransport F(leaky, leaky.area());
    solve_conserving({F, rho, first, leaky.area()}, F, closed, Relaxation::gmres, b, {.residual = 1e-12});
    F.gather(b, E);
    double power = 0, in = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        power += leaky.area()[i] * 0.1 * E[i][0];
        in += leaky.area()[i] * first[i][0];
    }
    return power / in;
}

TEST(ConservingTransport, ConservesLightInAClosedScene) {
    const LeakyTransport leaky(1e-3);
    EXPECT_NEAR(absorbed(leaky, false), 1 - 1e-2, 1.2e-3) << "of ten reflections a thousandth each";
    EXPECT_NEAR(absorbed(leaky, true), 1, 1e-9);  // limited by the solver's residual
}

TEST(ConservingTransport, ReportsReflectedPowerWithoutScaling) {
    const LeakyTransport leaky(1e-3);
    const std::vector<Spectrum> rho(4, Spectrum(0.9)), first = {Spectrum(1.0), Spectrum(), Spectrum(0.3), Spectrum()};
    std::vector<Spectrum> b = first;
    ConservingTransport F(leaky, leaky.area());
    const SolveReport report =
        solve_conserving({F, rho, first, leaky.area()}, F, true, Relaxation::gmres, b, {.residual = 1e-12});
    // Reflected power is t / (1 - t) of the sent power, where t = 0.9 with scaling and 0.8991 without.
    EXPECT_NEAR(report.unscaled[0], (0.8991 / 0.1009) / (0.9 / 0.1), 1e-9);
}

TEST(ConservingTransport, DoesNotCorrectLargeLosses) {
    const LeakyTransport leaky(0.3);
    EXPECT_EQ(absorbed(leaky, true), absorbed(leaky, false));
}

TEST(ConservingTransport, DoesNotReturnEscapedLight) {
    const LeakyTransport leaky(1.1e-2);
    const std::vector<double> kept(4, 0.99);
    const std::vector<Spectrum> b = {Spectrum(1.0), Spectrum(2.0), Spectrum(0.5), Spectrum(0.1)};
    ConservingTransport F(leaky, leaky.area(), kept);
    F.conserve(b);
    // F_ij depends on j only through its area, so that the same share of any b arrives.
    EXPECT_NEAR(F.scale()[0], 0.99 / (1 - 1.1e-2), 1e-12);
}

TEST(ConservingTransport, DoesNotScaleInAnOpenScene) {
    const LeakyTransport leaky(0.11);
    const std::vector<double> kept(4, 0.9);
    ConservingTransport F(leaky, leaky.area(), kept);
    F.conserve(std::vector<Spectrum>(4, Spectrum(1.0)));
    EXPECT_EQ(F.scale()[0], 1);
}

}  // namespace
}  // namespace exitance
