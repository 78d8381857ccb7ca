#include "exitance/base/spectrum.hpp"

namespace exitance {

template <>
const char LibraryOfBands<bands>::linked = 0;

}  // namespace exitance
