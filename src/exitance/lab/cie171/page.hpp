#pragma once

#include <string>
#include <vector>

#include "exitance/lab/studies/cie171.hpp"

namespace exitance {

/// Returns the validation page (Markdown): for every case the errors of all values next to the best published ones, and
/// for every scene the value with the largest error, exact and computed.
std::string cie171_page(const std::vector<Cie171Row>& rows);

}  // namespace exitance
