#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

/// Rows of text under names, as a CSV file holds them. All rows have as many fields as there are columns.
struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;

    bool has(std::string_view column) const;
    /// A field; empty where there is no such column.
    const std::string& text(std::size_t row, std::string_view column) const;
    /// The same as a number; NaN where it is none.
    double number(std::size_t row, std::string_view column) const;
    /// Sets a field of the last row; a column that is new stays empty in the rows before.
    void set(std::string_view column, std::string value);
    void add_row() { rows.emplace_back(columns.size()); }
    /// Adds the rows of another table, by the names of columns.
    void append(const Table& other);
};

/// Numbers as CSV files of studies hold them: 7 digits; empty for what is not finite.
std::string field(double value);

/// Writes some columns of a table (empty: all) as CSV; fields with commas, quotes or line ends stand in quotes.
Result<void> write_csv(const std::string& path, const Table& table, const std::vector<std::string>& columns = {});
/// A table of CSV text; the first line names the columns. Error: bad_input where a row has too few or too many fields.
Result<Table> parse_csv(const std::string& text, const std::string& where);
/// Reads what write_csv wrote. Error: cannot_read, or bad_input where a row has too few or too many fields.
Result<Table> read_csv(const std::string& path);

}  // namespace exitance
