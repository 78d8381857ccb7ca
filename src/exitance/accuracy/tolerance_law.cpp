#include "exitance/accuracy/tolerance_law.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {

double ToleranceLaw::factor(double error, double allowed) {
    constexpr double least = 0.03, most = 0.9;  // no step that helps little or cannot be foreseen
    constexpr double steepest = 3, aim = 0.95;
    double exponent = exponent_;
    if (round_ > 1 && last_factor_ < 1) {
        const double fallen =
            std::log(error / last_error_) / std::log(last_factor_);  // as which power of the tolerance
        exponent = fallen > 0 ? std::clamp(1 / fallen, exponent_, std::max(exponent_, steepest)) : steepest;
    }
    ++round_;
    last_error_ = error;
    last_factor_ = error > allowed ? std::clamp(std::pow(aim * allowed / error, exponent), least, most) : 1;
    return last_factor_;
}

}  // namespace exitance
