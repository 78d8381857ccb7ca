#include "exitance/io/files/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

std::optional<std::size_t> place(const std::vector<std::string>& columns, std::string_view name) {
    const auto at = std::find(columns.begin(), columns.end(), name);
    if (at == columns.end()) return std::nullopt;
    return static_cast<std::size_t>(at - columns.begin());
}

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"') out += '"';
        out += c;
    }
    out += '"';
    return out;
}

/// Returns the bytes of the line at `at`, with its end, if it has blanks only; 0 if it has other characters.
std::size_t blank_line_size(const std::string& text, std::size_t at) {
    const std::size_t end = std::min(text.find_first_not_of(" \t\r", at), text.size());
    if (end == text.size()) return end - at;
    return text[end] == '\n' ? end + 1 - at : 0;
}

/// Returns the fields of the line at `at`, which is advanced to the next line; quoted fields may contain line ends.
/// Empty if a quote is not closed.
std::vector<std::string> next_fields(const std::string& text, std::size_t& at) {
    std::vector<std::string> fields(1);
    bool in_quotes = false;
    for (; at < text.size(); ++at) {
        const char c = text[at];
        if (in_quotes && c == '"' && at + 1 < text.size() && text[at + 1] == '"')
            fields.back() += '"', ++at;
        else if (c == '"')
            in_quotes = !in_quotes;
        else if (!in_quotes && c == ',')
            fields.emplace_back();
        else if (!in_quotes && c == '\n')
            return ++at, fields;
        else if (in_quotes || c != '\r')
            fields.back() += c;
    }
    if (in_quotes) return {};
    return fields;
}

}  // namespace

bool Table::has(std::string_view column) const {
    return place(columns, column).has_value();
}

std::size_t Table::count(std::string_view column) const {
    return static_cast<std::size_t>(std::count(columns.begin(), columns.end(), column));
}

const std::string& Table::text(std::size_t row, std::string_view column) const {
    static const std::string nothing;
    const std::optional<std::size_t> at = place(columns, column);
    return at ? rows[row][*at] : nothing;
}

double Table::number(std::size_t row, std::string_view column) const {
    return parse_number(text(row, column)).value_or(std::numeric_limits<double>::quiet_NaN());
}

void Table::set(std::string_view column, std::string value) {
    std::optional<std::size_t> at = place(columns, column);
    if (!at) {
        at = columns.size();
        columns.emplace_back(column);
        for (std::vector<std::string>& row : rows) row.emplace_back();
    }
    rows.back()[*at] = std::move(value);
}

void Table::append(const Table& other) {
    for (const std::vector<std::string>& row : other.rows) {
        add_row();
        for (std::size_t i = 0; i < other.columns.size(); ++i) set(other.columns[i], row[i]);
    }
}

std::string field(double value) {
    return std::isfinite(value) ? fmt::format("{:.7g}", value) : "";
}

Result<void> write_csv(const std::string& path, const Table& table, const std::vector<std::string>& columns) {
    const std::vector<std::string>& names = columns.empty() ? table.columns : columns;
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    std::string line;
    for (const std::string& name : names) {
        if (!line.empty()) line += ',';
        line += quoted(name);
    }
    line += '\n';
    file->write(line);
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (i > 0) file->write(",");
            const std::string field = quoted(table.text(row, names[i]));
            // A line without any character would be skipped by readers.
            file->write(field.empty() && names.size() == 1 ? "\"\"" : field);
        }
        file->write("\n");
    }
    return file->commit();
}

Result<Table> read_csv(const std::string& path) {
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text.error();
    return parse_csv(*text, path);
}

Result<Table> parse_csv(const std::string& text, const std::string& where) {
    Table table;
    bool has_columns = false;
    int line = 1;
    for (std::size_t at = text.starts_with("\xef\xbb\xbf") ? 3 : 0; at < text.size();) {
        const std::size_t begin = at;
        const std::string here = fmt::format("{}:{}", where, line);
        if (const std::size_t blank = blank_line_size(text, at); blank > 0) {
            at += blank, ++line;
            continue;
        }
        std::vector<std::string> fields = next_fields(text, at);
        line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                            text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
        if (fields.empty())
            return Error{ErrorCode::bad_input, "a quote is not closed", here,
                         "close it, and write a quote within quotes twice"};
        if (has_columns && fields.size() != table.columns.size())
            return Error{
                ErrorCode::bad_input,
                fmt::format("row has {} fields where there are {} columns", fields.size(), table.columns.size()), here,
                "separate fields by commas, and put a field with a comma into double quotes"};
        if (has_columns)
            table.rows.push_back(std::move(fields));
        else
            table.columns = std::move(fields), has_columns = true;
    }
    return table;
}

}  // namespace exitance
