#pragma once

#include <string>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"

namespace exitance {

/// Returns an error with advice if no program that prints pages is in PATH: Chromium or Chrome.
Result<void> find_page_printer(const std::string& path);

/// Prints a page (.html) as PDF, A4, by Chromium without a window. The file appears whole or not at all. A stop ends
/// the printing.
Result<void> print_page(const std::string& page, const std::string& path, const StopRequest& stop);

}  // namespace exitance
