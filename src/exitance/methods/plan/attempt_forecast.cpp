#include "exitance/methods/plan/attempt_forecast.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/calibration/numbers.hpp"

namespace exitance {

AttemptForecast forecast_attempt(const AttemptFacts& facts) {
    AttemptForecast out;
    // Each way takes as many attempts as bring the part below what is wanted: a power of what one leaves.
    const auto attempts = [&](double left) {
        if (facts.method <= facts.wanted || left <= 0) return 1.0;
        if (left >= 1) return HUGE_VAL;
        return std::max(1.0, std::ceil(std::log(facts.wanted / facts.method) / std::log(left)));
    };
    out.steps = attempts(facts.left);
    constexpr double share_of_change = 0x1p-3;  // that LocalPass begins with
    out.step_rays = out.steps * (share_of_change * facts.gather_rays + facts.certificate_rays);
    double rows = facts.row_rays;
    const double finer = attempts(facts.finer);
    constexpr int most = 16;  // beyond these nothing would be gained by knowing more
    for (int k = 0; k < most && k < finer; ++k) {
        rows /= facts.finer * facts.finer;
        out.finer_rays += rows + facts.gather_rays + facts.certificate_rays;
    }
    return out;
}

std::vector<double> attempt_aims(double asked, double error) {
    std::vector<double> out = {asked};
    const double most = calibrated::part_aim * error;
    for (double aim = asked / calibrated::least_step; aim <= most; aim /= calibrated::least_step) out.push_back(aim);
    return out;
}

}  // namespace exitance
