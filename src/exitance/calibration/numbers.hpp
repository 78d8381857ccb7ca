#pragma once

namespace exitance {

/// All numbers on the path of a solve that neither mathematics nor a standard gives. Their meanings, units and what
/// they trade stand in `numbers.inc`, the one table. Nothing but `TriedNumber` changes what they refer to; a value
/// costs what a literal in memory costs.
namespace calibrated {
#define EXITANCE_NUMBER(name, value, unit, trades, range, command) \
    namespace stored {                                             \
    inline constinit double name = value;                          \
    }                                                              \
    inline constexpr const double& name = stored::name;
#include "exitance/calibration/numbers.inc"
#undef EXITANCE_NUMBER
}  // namespace calibrated

}  // namespace exitance
