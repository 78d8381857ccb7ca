#include "exitance/lab/tasks/interaction_forecast.hpp"

#include <algorithm>

namespace exitance {

double predict_interactions(std::span<const PiecePair> pairs, const std::function<double(std::uint32_t)>& area,
                            const std::function<double(std::uint32_t)>& power, const TaskOptions& options) {
    double sum = 0;
    for (const PiecePair& pair : pairs) {
        double receiver = area(pair.receiver), source = area(pair.source);  // areas of one part after the cuts so far
        double F = static_cast<double>(pair.form_factor), parts = 1;
        const double B = power(pair.source);
        for (int levels = 0; levels < 2 * PatchPool::deepest; ++levels) {
            const double strength = options.by_power ? F * receiver * B : F * std::max(1.0, receiver / source);
            double& larger = receiver > source ? receiver : source;
            if (strength <= options.threshold || larger / 4 < options.min_area) break;
            if (&larger == &source) F /= 4;
            larger /= 4;
            parts *= 4;
        }
        sum += parts;
    }
    return sum;
}

}  // namespace exitance
