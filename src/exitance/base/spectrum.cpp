#include "exitance/base/spectrum.hpp"

namespace exitance {

template <std::size_t n>
const char LibraryOfBands<n>::linked = 0;

template struct LibraryOfBands<bands>;

}  // namespace exitance
