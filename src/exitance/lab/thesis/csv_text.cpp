#include "exitance/lab/thesis/csv_text.hpp"

#include <array>
#include <cstdarg>
#include <cstdio>

namespace exitance {

void CsvText::print(const char* format, ...) {
    std::array<char, 1024> line;
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(line.data(), line.size(), format, values);
    va_end(values);
    text_ += line.data();
}

}  // namespace exitance
