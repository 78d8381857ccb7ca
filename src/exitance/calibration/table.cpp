#include "exitance/calibration/table.hpp"

#include <algorithm>
#include <array>

namespace exitance {
namespace {

constexpr std::array table{
#define EXITANCE_NUMBER(name, value, unit, effect, range, command) \
    CalibratedNumber{#name, &calibrated::stored::name, unit, effect, range, command},
#include "exitance/calibration/numbers.inc"
#undef EXITANCE_NUMBER
};

}  // namespace

std::span<const CalibratedNumber> calibration_table() {
    return table;
}

const CalibratedNumber* find_calibrated(std::string_view name) {
    const auto at = std::find_if(table.begin(), table.end(), [&](const CalibratedNumber& n) { return n.name == name; });
    return at == table.end() ? nullptr : &*at;
}

}  // namespace exitance
