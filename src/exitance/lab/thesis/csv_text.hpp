#pragma once

#include <string>

namespace exitance {

/// Lines of CSV, formatted by printf.
class CsvText {
  public:
    [[gnu::format(printf, 2, 3)]] void print(const char* format, ...);
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

}  // namespace exitance
