#include "exitance/methods/plan/attempt_forecast.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/calibration/numbers.hpp"

namespace exitance {

AttemptForecast forecast_attempt(const AttemptFacts& facts) {
    AttemptForecast out;
    // Returns the number of attempts that reduce the part to the required value, if each multiplies it by `left`.
    const auto attempts = [&](double left) {
        if (facts.method <= facts.wanted || left <= 0) return 1.0;
        if (left >= 1) return HUGE_VAL;
        return std::max(1.0, std::ceil(std::log(facts.wanted / facts.method) / std::log(left)));
    };
    out.steps = attempts(facts.left);
    constexpr double share_of_change = 0x1p-3;  // initial share of the rays with which LocalPass gathers a change
    out.step_rays = out.steps * (share_of_change * facts.gather_rays + facts.certificate_rays);
    double rows = facts.row_rays;
    const double finer = attempts(facts.finer);
    constexpr int max_attempts = 16;  // forecasts beyond this many attempts would not change the decision
    for (int k = 0; k < max_attempts && k < finer; ++k) {
        rows /= facts.finer * facts.finer;
        out.finer_rays += rows + facts.gather_rays + facts.certificate_rays;
    }
    return out;
}

std::vector<double> attempt_aims(double asked, double error) {
    std::vector<double> out = {asked};
    const double max_aim = calibrated::part_aim * error;
    for (double aim = asked / calibrated::max_tightening_factor; aim <= max_aim;
         aim /= calibrated::max_tightening_factor)
        out.push_back(aim);
    return out;
}

}  // namespace exitance
