#include "exitance/base/distinct_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace exitance {
namespace {

/// Number of digits before the decimal point after rounding to `digits`; 0 for numbers that are written with an
/// exponent.
int whole_digits(double value, int digits) {
    constexpr double max_plain = 1e9;  // derived from memory in MiB, the largest numbers that messages compare
    const double size = std::stod(fmt::format("{:.{}g}", std::abs(value), digits));
    return size >= 1 && size < max_plain ? static_cast<int>(std::floor(std::log10(size))) + 1 : 0;
}

}  // namespace

NumberTexts distinct_texts(double first, double second, int digits) {
    digits = std::max({digits, whole_digits(first, digits), whole_digits(second, digits)});
    while (true) {
        NumberTexts out{fmt::format("{:.{}g}", first, digits), fmt::format("{:.{}g}", second, digits)};
        if (first == second || out.first != out.second || digits >= std::numeric_limits<double>::max_digits10)
            return out;
        ++digits;
    }
}

NumberTexts distinct_percents(double first, double second, int digits) {
    constexpr double percent = 100;  // derived from the unit
    double a = percent * first;
    const double b = percent * second;
    // Shares that differ in the last bit may have equal products.
    if (a == b && first != second) a = std::nextafter(b, first > second ? HUGE_VAL : -HUGE_VAL);
    return distinct_texts(a, b, digits);
}

}  // namespace exitance
