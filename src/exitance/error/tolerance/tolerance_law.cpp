#include "exitance/error/tolerance/tolerance_law.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/calibration/numbers.hpp"

namespace exitance {

double ToleranceLaw::factor(double error, double allowed) {
    const double steepest = calibrated::steepest_tolerance, aim = calibrated::tolerance_aim;
    double exponent = exponent_;
    if (round_ > 1 && last_factor_ < 1) {
        const double fallen =
            std::log(error / last_error_) / std::log(last_factor_);  // measured power of the tolerance
        exponent = fallen > 0 ? std::clamp(1 / fallen, exponent_, std::max(exponent_, steepest)) : steepest;
    }
    ++round_;
    last_error_ = error;
    last_factor_ = error > allowed ? std::clamp(std::pow(aim * allowed / error, exponent), calibrated::min_round_factor,
                                                calibrated::max_tightening_factor)
                                   : 1;
    return last_factor_;
}

}  // namespace exitance
