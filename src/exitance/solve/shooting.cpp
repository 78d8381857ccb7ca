#include "exitance/solve/shooting.hpp"

#include <cmath>
#include <numeric>

#include "exitance/base/groups.hpp"
#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

double power_of(const Spectrum& u, double area) {
    double sum = 0;
    for (double v : u.value) sum += std::abs(v);
    return area * sum / static_cast<double>(bands);
}

/// What is unshot, and which patch has most to send.
struct Unshot {
    double power = 0;  ///< W
    Spectrum flux;     ///< sum A u, W
    double most = -1;  ///< W, of the first patch of those that would send most.
    std::size_t patch = 0;

    /// Patch p would send `sent`, of which u is unshot; W/m^2.
    void add(std::size_t p, const Spectrum& u, const Spectrum& sent, double area) {
        power += power_of(u, area);
        flux += area * u;
        choose(p, power_of(sent, area));
    }
    void add(const Unshot& later) {
        power += later.power;
        flux += later.flux;
        choose(later.patch, later.most);
    }

  private:
    void choose(std::size_t p, double own) {
        if (own > most) most = own, patch = p;
    }
};

/// Patches in blocks, which threads take in turn; sums go by block, so that they do not depend on threads.
class Patches {
  public:
    Patches(const ShootingProblem& problem, bool overshooting, std::span<Spectrum> unshot,
            std::span<Spectrum> irradiance)
        : area_(problem.patch_area),
          overshooting_(overshooting),
          unshot_(unshot),
          irradiance_(irradiance),
          receivers_(problem.patch_of, unshot.size()),
          total_area_(std::accumulate(area_.begin(), area_.end(), 0.0)),
          returned_(irradiance.size()),
          reflectance_(unshot.size()),
          blocks_((unshot.size() + block - 1) / block) {
        for (std::size_t i = 0; i < irradiance.size(); ++i) {
            const std::uint32_t p = problem.patch_of[i];
            returned_[i] = (problem.receiver_area[i] / area_[p]) * problem.reflectance[i];
            reflectance_[p] += returned_[i];
            mean_reflectance_ += (problem.receiver_area[i] / total_area_) * problem.reflectance[i];
        }
        receive({}, {});
    }

    const Unshot& unshot() const { return sum_; }

    /// Takes from patch p what it sends.
    Spectrum send(std::size_t p) {
        const Spectrum extra = expected(p), sent = unshot_[p] + extra;
        unshot_[p] = -1.0 * extra;
        return sent;
    }

    /// Light `sent` arrives by form factors F, by receiver; none if there are none.
    void receive(std::span<const float> F, const Spectrum& sent) {
        sum_ = over_blocks([&](std::size_t p) {
            if (!F.empty()) receive_at(p, F, sent);
            return unshot_[p];
        });
        if (!overshooting_) return;
        for (std::size_t b = 0; b < bands; ++b)
            ambient_[b] = std::max(0.0, sum_.flux[b]) / (total_area_ * (1 - mean_reflectance_[b]));
        sum_ = over_blocks([&](std::size_t p) { return unshot_[p] + expected(p); });
    }

  private:
    static constexpr std::size_t block = 512;

    /// What is unshot once `sent(p)` has been called for every patch, which tells what it would send.
    template <class Sent>
    Unshot over_blocks(const Sent& sent) {
        parallel_for(blocks_.size(), 4, [&](std::size_t b) {
            blocks_[b] = {};
            for (std::size_t p = b * block; p < std::min(unshot_.size(), (b + 1) * block); ++p) {
                const Spectrum would_send = sent(p);
                blocks_[b].add(p, unshot_[p], would_send, area_[p]);
            }
        });
        Unshot sum;
        for (const Unshot& u : blocks_) sum.add(u);
        return sum;
    }

    void receive_at(std::size_t p, std::span<const float> F, const Spectrum& sent) {
        for (std::uint32_t i : receivers_[p]) {
            if (F[i] == 0) continue;
            const Spectrum arrived = static_cast<double>(F[i]) * sent;
            irradiance_[i] += arrived;
            unshot_[p] += returned_[i] * arrived;
        }
    }

    /// What patch p may expect to have to send later.
    Spectrum expected(std::size_t p) const { return reflectance_[p] * ambient_; }

    std::span<const double> area_;  ///< By patch, m^2.
    bool overshooting_;
    std::span<Spectrum> unshot_, irradiance_;
    Groups receivers_;  ///< By patch.
    double total_area_;
    std::vector<Spectrum> returned_;     ///< By receiver: its reflectance, times its share of its patch.
    std::vector<Spectrum> reflectance_;  ///< By patch.
    Spectrum mean_reflectance_;
    Spectrum
        ambient_;  ///< If overshooting, mean of what is unshot and its reflections: sum A u / sum A / (1 - mean rho).
    std::vector<Unshot> blocks_;
    Unshot sum_;
};

}  // namespace

double unshot_power(std::span<const Spectrum> unshot, std::span<const double> patch_area) {
    double sum = 0;
    for (std::size_t p = 0; p < unshot.size(); ++p) sum += power_of(unshot[p], patch_area[p]);
    return sum;
}

SolveReport shoot(const ShootingProblem& problem, const ShootingOptions& options, std::span<Spectrum> unshot,
                  std::span<Spectrum> irradiance) {
    Patches patches(problem, options.overshooting, unshot, irradiance);
    const double at_first = options.reference > 0 ? options.reference : patches.unshot().power;
    SolveReport report;
    while (at_first > 0) {
        report.residual = patches.unshot().power / at_first;
        report.converged = report.residual <= options.unshot;
        report.interrupted = !report.converged && options.request && options.request->requested();
        if (report.converged || report.interrupted || report.iterations >= options.max_shots) break;

        const std::size_t j = patches.unshot().patch;
        if (options.shot) options.shot(j, report.residual);
        const Spectrum sent = patches.send(j);
        patches.receive(problem.column(j), sent);
        ++report.iterations;
        if (options.progress && report.iterations % 16 == 0)
            options.progress->advance(std::log(report.residual) / std::log(options.unshot));
    }
    return report;
}

}  // namespace exitance
