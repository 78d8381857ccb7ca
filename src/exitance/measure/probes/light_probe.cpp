#include "exitance/measure/probes/light_probe.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/quadrature.hpp"
#include "exitance/base/random.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// A direction in which irradiance is evaluated, and its weights in the coefficients of radiance.
struct RuleNode {
    Normal n;
    Harmonics<double> weight;
};

/// Makes the rule for direct light,
///
///     L_1m = (V . axis) sqrt(3 / (4 pi)),    V_j = E(e_j) - E(-e_j) along the three axes,
///     L_lm = 2 / A_l int (E(n) - V . n / 2) Y_lm(n) dn over half of all directions, l = 0 or 2,
///
/// because the odd part of E is linear: E(n) - E(-n) = V . n, V = int L w dw. The integral is by Gauss-Legendre nodes
/// along z times equal steps around it.
std::vector<RuleNode> make_rule() {
    constexpr int rows = 12, columns = 2 * rows;          // number of rows and columns over the whole sphere
    constexpr std::array<std::size_t, 3> along{3, 1, 2};  // harmonics that are proportional to x, y, z
    std::vector<RuleNode> rule;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
            RuleNode node{{0, 0, 0}, {}};
            node.n[axis] = sign;
            node.weight[along[axis]] = sign * harmonics_at({1, 0, 0})[along[0]];
            rule.push_back(node);
        }
    const LineRule heights = gauss_legendre(rows);
    for (std::size_t row = rows / 2; row < rows; ++row)
        for (int k = 0; k < columns; ++k) {
            const double z = 2 * heights.nodes[row] - 1, angle = 2 * pi * (k + 0.5) / columns;
            const double r = std::sqrt(1 - z * z);
            RuleNode node{{r * std::cos(angle), r * std::sin(angle), z}, {}};
            const Harmonics<double> Y = harmonics_at(node.n);
            for (std::size_t i = 0; i < harmonic_count; ++i) {
                if (degree_of(i) == 1) continue;
                node.weight[i] = 8 * pi * heights.weights[row] / columns * Y[i] / irradiance_factors[degree_of(i)];
                for (std::size_t v = 0; v < 6; ++v)
                    rule[v].weight[i] -= 0.5 * node.weight[i] * node.n[v / 2] * rule[v].n[v / 2];
            }
            rule.push_back(node);
        }
    return rule;
}

/// Solves A x = b for a symmetric positive definite matrix by Cholesky's decomposition, for all columns of b.
void solve_symmetric(Harmonics<Harmonics<double>>& A, Harmonics<Spectrum>& b) {
    for (std::size_t j = 0; j < harmonic_count; ++j) {
        for (std::size_t k = 0; k < j; ++k) A[j][j] -= A[j][k] * A[j][k];
        A[j][j] = std::sqrt(A[j][j]);
        for (std::size_t i = j + 1; i < harmonic_count; ++i) {
            for (std::size_t k = 0; k < j; ++k) A[i][j] -= A[i][k] * A[j][k];
            A[i][j] /= A[j][j];
        }
    }
    for (std::size_t i = 0; i < harmonic_count; ++i) {
        for (std::size_t k = 0; k < i; ++k) b[i] -= A[i][k] * b[k];
        b[i] = b[i] / A[i][i];
    }
    for (std::size_t i = harmonic_count; i-- > 0;) {
        for (std::size_t k = i + 1; k < harmonic_count; ++k) b[i] -= A[k][i] * b[k];
        b[i] = b[i] / A[i][i];
    }
}

/// Computes probes one after the other. One per thread; keeps its memory.
class Prober {
  public:
    Prober(const RadiosityFunction& light, const ElementLocator& locator, std::span<const RuleNode> rule, unsigned rays)
        : light_(light),
          locator_(locator),
          accuracy_(point_accuracy(light.solution().statistics.relative_error_estimate.value_or(1))),
          rule_(rule),
          rays_(rays),
          directions_(rays),
          hits_(rays),
          radiance_(rays),
          Y_(rays) {}

    LightProbe at(const Point& x) {
        LightProbe out;
        add_reflected(x, out);
        add_direct(x, out);
        return out;
    }

  private:
    /// Reflected radiosity, from the exported elements, W/m^2.
    Spectrum reflected(RegionId region, const Point& y) const {
        const Solution& solution = light_.solution();
        if (solution.bounces == 0) return Spectrum();
        return solution.scene.material(region).reflectance * solution.interpolant.at(locator_.find(region, y));
    }

    void cast(const Point& x) {
        const ScrambledSobol points(hash(RayLight::key_of(x, RegionId()), static_cast<std::uint64_t>(Stream::gather)));
        std::vector<double> a(rays_), b(rays_);
        points.fill(0, 0, a), points.fill(0, 1, b);
        for (std::size_t k = 0; k < rays_; ++k) {
            directions_[k] = direction_at(1 - 2 * a[k], b[k]);
            Y_[k] = harmonics_at(directions_[k]);
        }
        light_.stage().tracer.nearest(directions_, x, RegionId(), hits_, Mirrored::followed);
    }

    void add_reflected(const Point& x, LightProbe& out) {
        cast(x);
        std::size_t backs = 0;
        for (std::size_t k = 0; k < rays_; ++k) {
            const RayHit& hit = hits_[k];
            radiance_[k] = {};
            if (hit.surface.is_none()) continue;
            backs += !hit.front;
            if (hit.front)
                radiance_[k] = light_.stage().glass.of(hit, x, directions_[k]) *
                               reflected(hit.region, place_of(light_.stage().scene, hit, x, directions_[k])) / pi;
        }
        out.back_share = static_cast<double>(backs) / rays_;
        fit(out);
    }

    void fit(LightProbe& out) {
        Harmonics<Harmonics<double>> gram{};
        Harmonics<Spectrum> sum{};
        for (std::size_t k = 0; k < rays_; ++k)
            for (std::size_t i = 0; i < harmonic_count; ++i) {
                for (std::size_t j = 0; j <= i; ++j) gram[i][j] += Y_[k][i] * Y_[k][j];
                sum[i] += Y_[k][i] * radiance_[k];
            }
        solve_symmetric(gram, sum);
        out.radiance = sum;
        // The residuals of all rays together are orthogonal to the harmonics; those of a quarter are not.
        std::array<Harmonics<Spectrum>, 4> quarter{};
        for (std::size_t k = 0; k < rays_; ++k) {
            Spectrum residual = radiance_[k];
            for (std::size_t i = 0; i < harmonic_count; ++i) residual -= Y_[k][i] * sum[i];
            for (std::size_t i = 0; i < harmonic_count; ++i) quarter[4 * k / rays_][i] += Y_[k][i] * residual;
        }
        for (std::size_t i = 0; i < harmonic_count; ++i)
            for (const Harmonics<Spectrum>& q : quarter) {
                const Spectrum apart = 4 * pi * 4 / rays_ * q[i];
                variance_of(out, i) += 1.0 / 12 * (apart * apart);
            }
        for (Spectrum& variance : out.standard_error)
            for (double& value : variance.value) value = std::sqrt(value);
    }
    /// Until the fit is complete, the fields for standard errors store variances.
    static Spectrum& variance_of(LightProbe& probe, std::size_t i) { return probe.standard_error[i]; }

    void add_direct(const Point& x, LightProbe& out) {
        for (const RuleNode& node : rule_) {
            const PlaceLight::Estimate E = light_.stage().place_light.at(x, node.n, RegionId(), accuracy_, workspace_);
            // Errors in several directions come from the same random numbers: they may add up.
            const Spectrum error = E.standard_error();
            for (std::size_t i = 0; i < harmonic_count; ++i) {
                out.radiance[i] += node.weight[i] * E.irradiance;
                out.standard_error[i] += std::abs(node.weight[i]) * error;
            }
        }
    }

    const RadiosityFunction& light_;
    const ElementLocator& locator_;  ///< Finds exported elements.
    const LightAccuracy accuracy_;   ///< Accuracy of direct light where it is estimated by rays.
    std::span<const RuleNode> rule_;
    unsigned rays_;
    std::vector<Vec3> directions_;
    std::vector<RayHit> hits_;
    std::vector<Spectrum> radiance_;  ///< Radiance along each ray, W/(m^2 sr).
    std::vector<Harmonics<double>> Y_;
    PlaceLight::Workspace workspace_;
};

}  // namespace

std::vector<LightProbe> light_probes(const RadiosityFunction& light, std::span<const Point> points, unsigned rays,
                                     Progress& progress, const StopRequest& stop) {
    const std::vector<RuleNode> rule = make_rule();
    const Solution& solution = light.solution();
    const ElementLocator locator(solution.interpolant.tree, solution.scene.regions().size());
    progress.phase("probes");
    constexpr std::size_t at_once = 256, grain = 8;
    std::vector<LightProbe> out;
    while (out.size() < points.size() && !stop.requested()) {
        const std::size_t first = out.size();
        progress.advance(static_cast<double>(first) / static_cast<double>(points.size()));
        out.resize(std::min(points.size(), first + at_once));
        parallel_ranges(out.size() - first, grain, [&](std::size_t begin, std::size_t end) {
            Prober prober(light, locator, rule, rays);
            for (std::size_t i = begin; i < end && !stop.requested(); ++i)
                out[first + i] = prober.at(points[first + i]);
        });
        if (stop.requested()) out.resize(first);
    }
    return out;
}

}  // namespace exitance
