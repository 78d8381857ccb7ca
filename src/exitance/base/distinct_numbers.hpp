#pragma once

#include <string>

namespace exitance {

/// Texts of two numbers that a message compares.
struct NumberTexts {
    std::string first, second;
};

/// Formats two numbers with `digits` significant digits, with all digits before the decimal point, and with as many
/// more as are needed for different numbers to have different texts. Trailing zeros are left out.
NumberTexts distinct_texts(double first, double second, int digits = 3);

/// Like the above, for shares that a message states in percent; the texts have no percent sign.
NumberTexts distinct_percents(double first, double second, int digits = 3);

}  // namespace exitance
