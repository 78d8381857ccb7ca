#pragma once

#include <charconv>
#include <cstdio>
#include <span>
#include <string>

#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Appends numbers in the format of printf.
template <class... Values>
void append_formatted(std::string& text, const char* format, Values... values) {
    char buffer[64];
    const int length = std::snprintf(buffer, sizeof buffer, format, values...);
    text.append(buffer, static_cast<std::size_t>(length));
}

/// Appends `value` as %.17g would, without loss, but faster: formatting millions of entries dominates the time to
/// write.
inline void append_exactly(std::string& text, double value) {
    char buffer[64];
    text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 17).ptr);
}

/// A text format: text before the rows, each row, and text after them.
class TextFormat {
  public:
    explicit TextFormat(const SparseFactors& table) : table_(table) {}
    virtual ~TextFormat() = default;
    virtual void begin(std::string& text) const = 0;
    virtual void add_row(std::string& text, std::size_t i) const = 0;
    virtual void end(std::string& /*text*/) const {}

  protected:
    /// Calls take(F) for every column of a row, including zeros.
    template <class Take>
    void for_all_columns(std::size_t i, const Take& take) const {
        const std::span<const std::uint32_t> columns = table_.row_columns(i);
        std::size_t k = 0;
        for (std::size_t j = 0; j < table_.size(); ++j)
            take(k < columns.size() && columns[k] == j ? table_.row_values(i)[k++] : 0.0);
    }
    const SparseFactors& table_;
};

}  // namespace exitance
