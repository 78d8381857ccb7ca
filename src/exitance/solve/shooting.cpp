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

/// Unshot power, and the patch that has most to send.
struct Unshot {
    double power = 0;  ///< W
    Spectrum flux;     ///< Sum of area times unshot light over all patches, W.
    /// Power that patch `patch` would send, W: the largest of all patches (the first one if several are equal).
    double most = -1;
    std::size_t patch = 0;

    /// Adds patch p with unshot light u, which would send `sent` in a shot; both W/m^2.
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

/// All patches in blocks, which threads process in parallel. Sums are formed by block and do not depend on threads.
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

    /// Removes from patch p the light that a shot sends, and returns it, W/m^2.
    Spectrum send(std::size_t p) {
        const Spectrum extra = expected(p), sent = unshot_[p] + extra;
        unshot_[p] = -1.0 * extra;
        return sent;
    }

    /// Adds the arriving part of the light `sent`, by form factors F (one per receiver). If F is empty, only updates
    /// the sums.
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

    /// Calls `sent(p)` for every patch and sums up the unshot light. `sent` returns the radiosity that a shot of patch
    /// p would send; it may change the patch's unshot light first.
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

    /// Estimate of the light that patch p will receive and reflect later, W/m^2; 0 without overshooting.
    Spectrum expected(std::size_t p) const { return reflectance_[p] * ambient_; }

    std::span<const double> area_;  ///< Area of each patch, m^2.
    bool overshooting_;
    std::span<Spectrum> unshot_, irradiance_;
    Groups receivers_;  ///< Receivers of each patch.
    double total_area_;
    std::vector<Spectrum> returned_;     ///< Per receiver: reflectance times its share of its patch's area.
    std::vector<Spectrum> reflectance_;  ///< Mean reflectance of each patch.
    Spectrum mean_reflectance_;
    /// With overshooting: mean of the unshot light with all its reflections, sum A u / sum A / (1 - mean rho), W/m^2.
    Spectrum ambient_;
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
