#pragma once

namespace exitance {

/// Numbers that affect a solve and follow neither from mathematics nor from a standard. They were chosen by trial.
/// `numbers.inc` is the table of their units and effects, and of the sensitivity of solves to those for which it has
/// been measured; the other rows say "not measured". Only `TriedNumber` changes their values. Reading one costs as much
/// as loading a constant from memory.
namespace calibrated {
#define EXITANCE_NUMBER(name, value, unit, effect, range, command) \
    namespace stored {                                             \
    inline constinit double name = value;                          \
    }                                                              \
    inline constexpr const double& name = stored::name;
#include "exitance/calibration/numbers.inc"
#undef EXITANCE_NUMBER
}  // namespace calibrated

}  // namespace exitance
