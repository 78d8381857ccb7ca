#pragma once

#include <string>
#include <vector>

#include "exitance/lab/studies/cie171.hpp"

namespace exitance {

/// The validation page (Markdown): for every case how far all values are off, beside the best that others have
/// published, and for every scene of it the value that is farthest off, exact and as computed.
std::string cie171_page(const std::vector<Cie171Row>& rows);

}  // namespace exitance
