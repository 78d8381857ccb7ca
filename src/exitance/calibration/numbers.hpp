#pragma once

namespace exitance {

/// All numbers that affect a solve and come from measurements, not from mathematics or a standard. `numbers.inc` is the
/// table of their meanings, units and trade-offs. Only `TriedNumber` changes their values. Reading one costs as much as
/// loading a constant from memory.
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
