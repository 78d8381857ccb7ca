#include "exitance/what_if/daylight/variant_tile.hpp"

#include <algorithm>

namespace exitance {

VariantTile::VariantTile(const HourlyStates& states, const DaylightCriteria& criteria, double bias, std::size_t sensors)
    : states_(states),
      criteria_(criteria),
      bias_(bias),
      results_(sensors * states.variants.size()),
      all_(states.occupied.size()),
      sum_(states.occupied.size()),
      picked_(states.parts.size(), all_) {}

/// Copies the occupied hours of a sensor.
void VariantTile::pick_occupied(std::size_t sensor, std::span<const float> lux,
                                std::span<const std::vector<float>> parts) {
    const std::size_t hours = lux.size() * states_.variants.size() / results_.size(), first = sensor * hours;
    for (std::size_t i = 0; i < all_.size(); ++i) {
        all_[i] = lux[first + states_.occupied[i]];
        for (std::size_t k = 0; k < parts.size(); ++k) picked_[k][i] = parts[k][first + states_.occupied[i]];
    }
}

/// Returns the light of a variant in the occupied hours of the picked sensor.
std::span<const float> VariantTile::combined(std::size_t variant) {
    std::copy(all_.begin(), all_.end(), sum_.begin());
    for (std::size_t k = 0; k < picked_.size(); ++k) {
        const float* const weights = states_.variants[variant].parts[k].data();
        const float* const part = picked_[k].data();
        for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += weights[i] * part[i];
    }
    return sum_;
}

void VariantTile::add(std::size_t replicate, std::span<const float> lux, std::span<const std::vector<float>> parts) {
    const std::size_t variants = states_.variants.size();
    const auto target = static_cast<float>(criteria_.target);
    for (std::size_t i = 0; i < results_.size() / variants; ++i) {
        pick_occupied(i, lux, parts);
        for (std::size_t v = 0; v < variants; ++v) {
            VariantResult& out = results_[i * variants + v];
            const std::span<const float> light = combined(v);
            std::int32_t reached = 0;
            for (const float E : light) reached += E >= target;
            const double autonomy = reached / std::max<double>(1, static_cast<double>(light.size()));
            if (replicate < daylight_replicates)
                out.autonomy.replicates[replicate] = autonomy;
            else
                out.autonomy.value = autonomy, add_mean(light, states_.variants[v], out);
        }
    }
}

/// Adds the results that only the mean of the replicates has.
void VariantTile::add_mean(std::span<const float> lux, const VariantWeights& weights, VariantResult& out) const {
    const auto less = static_cast<float>(1 - bias_), more = static_cast<float>(1 + bias_),
               target = static_cast<float>(criteria_.target);
    double with_less = 0, with_more = 0;
    for (std::size_t i = 0; i < lux.size(); ++i) {
        const float E = std::max(0.0f, lux[i]), twice = weights.uncertainty[i] * all_[i];
        with_less += E * less - twice >= target, with_more += E * more + twice >= target;
        out.continuous += double(std::min(1.0f, E / target)), out.illuminance += double(E);
    }
    const double hours = std::max<double>(1, static_cast<double>(lux.size()));
    out.autonomy.less = with_less / hours, out.autonomy.more = with_more / hours;
    out.continuous /= hours, out.illuminance /= hours;
}

void VariantTile::add_sun(std::span<const float> sun, std::span<const std::vector<float>> parts) {
    const std::size_t variants = states_.variants.size();
    for (std::size_t i = 0; i < results_.size() / variants; ++i) {
        pick_occupied(i, sun, parts);
        for (std::size_t v = 0; v < variants; ++v)
            for (std::size_t h = 0; h < all_.size(); ++h) {
                float E = all_[h];
                for (std::size_t g = 0; g < states_.variants[v].factors.size(); ++g)
                    E -= static_cast<float>(1 - states_.variants[v].factors[g]) * picked_[g][h];
                results_[i * variants + v].sunny_hours += E > static_cast<float>(sunny_illuminance);
            }
    }
}

void VariantTotals::add(std::span<const VariantResult> sensor) {
    ++sensors_;
    for (std::size_t v = 0; v < sensor.size(); ++v) {
        VariantSummary& sum = sums_[v];
        sum.continuous += sensor[v].continuous, sum.illuminance += sensor[v].illuminance;
        sum.exposure += sensor[v].sunny_hours > max_sunny_hours;
        for_each_value(reached_[v], sensor[v].autonomy,
                       [](double& count, double share) { count += share >= required_autonomy; });
    }
}

std::vector<VariantSummary> VariantTotals::summaries() const {
    const double n = std::max<double>(1, static_cast<double>(sensors_));
    std::vector<VariantSummary> out = sums_;
    for (std::size_t v = 0; v < out.size(); ++v) {
        out[v].autonomy = reached_[v].value / n, out[v].bounds = share_interval(reached_[v], n);
        out[v].exposure /= n, out[v].continuous /= n, out[v].illuminance /= n;
    }
    return out;
}

}  // namespace exitance
