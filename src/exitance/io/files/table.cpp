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

/// Returns the fields of the line at `at`, which is advanced to the next line; quoted fields may contain line ends.
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
    return fields;
}

}  // namespace

bool Table::has(std::string_view column) const {
    return place(columns, column).has_value();
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
            file->write(quoted(table.text(row, names[i])));
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
    std::size_t at = 0;
    table.columns = next_fields(text, at);
    for (int line = 2; at < text.size(); ++line) {
        std::vector<std::string> fields = next_fields(text, at);
        if (fields.size() != table.columns.size())
            return Error{
                ErrorCode::bad_input,
                fmt::format("row has {} fields where there are {} columns", fields.size(), table.columns.size()),
                fmt::format("{}:{}", where, line), ""};
        table.rows.push_back(std::move(fields));
    }
    return table;
}

}  // namespace exitance
