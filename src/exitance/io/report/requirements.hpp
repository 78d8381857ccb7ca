#pragma once

#include <limits>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/io/report/report_figures.hpp"

namespace exitance {

/// How a measured number compares with a required one.
enum class Fulfilment {
    reached,
    within_error,  ///< The difference to the required number is smaller than the error of the light.
    missed,
    not_measured  ///< No plane or observer of the report has this name, or the quantity is not computed.
};

/// One required number, the measured one, and the verdict.
struct Judgement {
    std::string where, quantity;  ///< Plane, observers or room, and symbol, see Requirement::Limit.
    std::string task = {};        ///< Name of the task that requires the number; empty: none.
    double required = 0;
    double reached = std::numeric_limits<double>::quiet_NaN();  ///< Reached value; NaN if it was not measured.
    Fulfilment verdict = Fulfilment::not_measured;
};

/// Parses a requirement such as "desk: Em 500, U0 0.6", "Ez 150" or "UGR 19": a name of planes (without one: all of
/// them) and lower limits of the mean illuminance Em, the uniformity U0 and the cylindrical illuminance Ez, or an upper
/// limit of the glare rating UGR of all observers. Error (usage): another quantity, or not a positive number.
Result<Requirement> read_requirement(const std::string& words);

/// Compares the measurements of a report with its requirements. A requirement on planes is judged for each plane of
/// that name. Mean illuminances may be off by the estimated error of the light, uniformity by twice as much, and UGR by
/// 8 log10(1 + error).
std::vector<Judgement> judge(const ReportContent& content, const ReportFigures& figures);

/// Words for the page: "reached", "reached within the error", "missed", "not measured".
std::string words_of(Fulfilment verdict);

}  // namespace exitance
