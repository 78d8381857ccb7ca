#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/transport/element_rays.hpp"
#include "exitance/transport/passed_light.hpp"

namespace exitance {
namespace {

/// One step of stochastic Jacobi iteration. Shoots `power` (flux that each element still has to send, W, all bands)
/// with about `rays` rays, distributed in proportion to power, and returns the flux that arrives at each element.
class Shooter {
  public:
    Shooter(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering, std::uint64_t seed)
        : stage_(stage),
          tree_(tree),
          numbering_(numbering),
          locator_(tree, stage.scene.regions().size()),
          passed_(stage.scene, tree, numbering.leaves),
          seed_(seed) {}

    std::vector<Spectrum> shoot(std::span<const Spectrum> power, double rays) {
        const std::size_t n = power.size();
        // Systematic sampling: ray k starts where the running sum of powers exceeds (k + offset) / rays of the total.
        double total = 0;
        for (const Spectrum& p : power) total += mean(p);
        RandomStream random(seed_, Stream::shooting, ++step_);
        const double offset = random.uniform();
        std::vector<std::size_t> first(n + 1, 0);
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) {
            sum += mean(power[i]);
            first[i + 1] =
                std::max(first[i], static_cast<std::size_t>(std::max(0.0, std::ceil(sum / total * rays - offset))));
        }
        std::vector<std::uint32_t> target(first[n], missed);
        std::vector<Spectrum> colour(stage_.glass.empty() ? 0 : first[n]);
        parallel_ranges(n, 16, [&](std::size_t begin, std::size_t end) { trace(first, begin, end, target, colour); });
        rays_shot += first[n];

        // Sum in the order of the rays, so that results are bitwise equal for any number of threads.
        std::vector<Spectrum> arrived(n);
        for (std::size_t i = 0; i < n; ++i) {
            if (first[i] == first[i + 1]) continue;
            const Spectrum carried = (total / (rays * mean(power[i]))) * power[i];
            for (std::size_t k = first[i]; k < first[i + 1]; ++k)
                if (target[k] != missed) arrived[target[k]] += colour.empty() ? carried : colour[k] * carried;
        }
        if (!passed_.empty()) pass(arrived);
        return arrived;
    }

    std::size_t rays_shot = 0;

  private:
    static constexpr std::uint32_t missed = ElementRays::missed;

    /// Adds the light that diffusing panes transmit, as flux.
    void pass(std::vector<Spectrum>& arrived) const {
        const auto area = [&](std::size_t i) { return tree_.area(numbering_.leaves[i]); };
        for (std::size_t i = 0; i < arrived.size(); ++i) arrived[i] = arrived[i] / area(i);
        passed_.meet(std::span(arrived));
        for (std::size_t i = 0; i < arrived.size(); ++i) arrived[i] = area(i) * arrived[i];
    }

    void trace(const std::vector<std::size_t>& first, std::size_t begin, std::size_t end,
               std::vector<std::uint32_t>& target, std::vector<Spectrum>& colour) const {
        ElementRays rays(stage_, tree_, locator_);
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t count = first[i + 1] - first[i];
            if (count == 0) continue;
            rays.cast(numbering_.leaves[i], hash(seed_, static_cast<std::uint64_t>(Stream::shooting), step_, i),
                      std::span(target).subspan(first[i], count), 0, ElementRays::Leave::front, {},
                      colour.empty() ? std::span<Spectrum>() : std::span(colour).subspan(first[i], count));
        }
    }

    const Stage& stage_;
    const ElementTree& tree_;
    const LeafNumbering& numbering_;
    ElementLocator locator_;
    PassedLight passed_;
    std::uint64_t seed_, step_ = 0;
};

}  // namespace

/// Stochastic Jacobi radiosity [Bekaert99], after [Neumann95]. Every sweep shoots the light that arrived in the last
/// one. The number of rays is proportional to the power left; the arriving light is an unbiased estimate. Independent
/// runs are averaged; their spread yields the standard error. O(rays), no form factors, memory of the elements only.
GlobalLight solve_monte_carlo(const MethodInput& input) {
    const Stage& stage = input.stage;
    const Knobs& knobs = input.knobs;
    ElementTree tree = input.direct.tree;
    LeafNumbering numbering(tree);
    const std::size_t n = numbering.leaves.size();
    const std::vector<Spectrum> rho = leaf_reflectances(stage.scene, tree, numbering);
    std::vector<Spectrum> direct = leaf_means(input.direct, numbering);

    input.progress.phase("shoot");
    Shooter shooter(stage, tree, numbering, input.options.seed);
    constexpr int runs = 8;
    std::vector<Spectrum> indirect(n), square(n);
    std::size_t sweeps = 0;
    double left_over = 0;
    for (int run = 0; run < runs && !input.stop.requested(); ++run) {
        std::vector<Spectrum> power(n), flux(n);
        for (std::size_t i = 0; i < n; ++i) power[i] = tree.area(numbering.leaves[i]) * (rho[i] * direct[i]);
        double first_power = 0, left = 0;
        for (const Spectrum& p : power) first_power += mean(p);
        for (left = first_power; left > knobs.residual * first_power && sweeps < runs * knobs.max_iterations;
             ++sweeps) {
            // The minimum is derived from the point generator, which makes blocks of 64 points.
            const double rays = std::max(64.0, knobs.solve_rays.average * static_cast<double>(n) * left / first_power);
            const std::vector<Spectrum> arrived = shooter.shoot(power, rays);
            left = 0;
            for (std::size_t i = 0; i < n; ++i) {
                flux[i] += arrived[i];
                power[i] = rho[i] * arrived[i];
                left += mean(power[i]);
            }
        }
        left_over = first_power > 0 ? left / first_power : 0;
        for (std::size_t i = 0; i < n; ++i) {
            const Spectrum E = flux[i] / tree.area(numbering.leaves[i]);
            indirect[i] += E / runs;
            square[i] += E * E / runs;
        }
        input.progress.advance((run + 1.0) / runs);
    }
    std::vector<Spectrum> reflected(n), standard_error(n);
    for (std::size_t i = 0; i < n; ++i) {
        reflected[i] = rho[i] * (direct[i] + indirect[i]);
        for (std::size_t b = 0; b < bands; ++b)
            standard_error[i][b] =
                std::sqrt(std::max(0.0, square[i][b] - indirect[i][b] * indirect[i][b]) / (runs - 1));
    }
    return {.tree = std::move(tree),
            .numbering = std::move(numbering),
            .direct = std::move(direct),
            .indirect = std::move(indirect),
            .reflected = std::move(reflected),
            .on_projection = true,
            .standard_error = std::move(standard_error),
            .report = {.iterations = sweeps, .residual = left_over, .converged = left_over <= knobs.residual},
            .work = {.rays = shooter.rays_shot}};
}

}  // namespace exitance
