#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

/// Rows of text with named columns, as in a CSV file. All rows have as many fields as there are columns.
struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;

    bool has(std::string_view column) const;
    /// Number of columns of this name. text() and number() return fields of the first one.
    std::size_t count(std::string_view column) const;
    /// Returns a field; empty if there is no such column.
    const std::string& text(std::size_t row, std::string_view column) const;
    /// Returns a field as a number; NaN if the field is not a number.
    double number(std::size_t row, std::string_view column) const;
    /// Sets a field of the last row; a new column stays empty in earlier rows.
    void set(std::string_view column, std::string value);
    void add_row() { rows.emplace_back(columns.size()); }
    /// Appends the rows of another table, matched by the names of columns.
    void append(const Table& other);
};

/// Formats a number for CSV files of studies: 7 digits; empty if not finite.
std::string field(double value);

/// Writes some columns of a table (empty: all) as CSV. Fields with commas, quotes or line ends are quoted, and so is an
/// empty field that is alone in its line.
Result<void> write_csv(const std::string& path, const Table& table, const std::vector<std::string>& columns = {});
/// Parses CSV text; the first line names the columns. Lines of blanks and a byte order mark are skipped. Error:
/// bad_input, if a row has too few or too many fields or a quote is not closed.
Result<Table> parse_csv(const std::string& text, const std::string& where);
/// Reads a CSV file, by parse_csv(). Error: cannot_read or bad_input.
Result<Table> read_csv(const std::string& path);

}  // namespace exitance
