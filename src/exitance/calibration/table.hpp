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
    std::string_view trades;  ///< What grows and what falls with the number.
    std::string_view range;   ///< Of factors on the number over which results do not care; or that it was not measured.
    std::string_view command;  ///< That measured the range; empty where it was not measured.
};

std::span<const CalibratedNumber> calibration_table();

/// The row of that name; null if there is none.
const CalibratedNumber* find_calibrated(std::string_view name);

/// Another value for a number as long as this lives, to measure what depends on it. Not while a solve runs.
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
