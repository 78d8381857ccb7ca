#pragma once

#include <span>
#include <string_view>

#include "exitance/calibration/numbers.hpp"

namespace exitance {

/// A row of the table of calibrated numbers.
struct CalibratedNumber {
    std::string_view name;
    double* stored;  ///< The value that solves read.
    std::string_view unit;
    std::string_view effect;   ///< Names what the number sets, and what improves and worsens if it is larger.
    std::string_view range;    ///< Range of factors on the number over which results hardly change; or "not measured".
    std::string_view command;  ///< Command that measured the range; empty if it was not measured.
};

std::span<const CalibratedNumber> calibration_table();

/// Returns the row of that name; null if there is none.
const CalibratedNumber* find_calibrated(std::string_view name);

/// Replaces the value of a number for the lifetime of this object, to measure its effect. Must not be created or
/// destroyed during a solve.
class TriedNumber {
  public:
    TriedNumber(const CalibratedNumber& number, double value) : stored_(*number.stored), own_(stored_) {
        stored_ = value;
    }
    ~TriedNumber() { stored_ = own_; }
    TriedNumber(const TriedNumber&) = delete;
    TriedNumber& operator=(const TriedNumber&) = delete;

  private:
    double& stored_;
    double own_;
};

}  // namespace exitance
