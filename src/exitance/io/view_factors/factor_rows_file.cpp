#include "exitance/io/view_factors/factor_rows_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace exitance {

void write_factor_rows(Hdf5Writer& file, const std::string& group, const SparseFactors& table) {
    file.write_rows<std::int64_t>(
        group + "/indptr", table.starts.size(), 1, {"1", "where rows begin in data, and the end"},
        [&](std::size_t i, std::span<std::int64_t> row) { row[0] = static_cast<std::int64_t>(table.starts[i]); });
    file.write_rows<std::int32_t>(
        group + "/indices", table.entries(), 1, {"1", "columns of data, from 0"},
        [&](std::size_t k, std::span<std::int32_t> row) { row[0] = static_cast<std::int32_t>(table.columns[k]); });
    file.write(group + "/data", table.values, 1, {"1", "view factors from the row's face to the column's"});
    file.write(group + "/areas", table.areas, 1, {"m^2", "areas of faces"});
    file.write(group + "/emittances", table.emittances, 1, {"1", "emittances of faces"});
    file.write(group + "/row_sums", table.row_sums, 1, {"1", "sums of rows"});
    file.write(group + "/finished", table.finished, 1, {"1", "1 for rows that were computed"});
    file.write(group + "/dropped", table.dropped, 1, {"1", "sums of entries of rows left out as too small"});
    if (!table.row_errors.empty())
        file.write(group + "/row_errors", table.row_errors, 1,
                   {"1", "root of the sum of the variances of a row, and bounds of what was integrated or dropped"});
    if (!table.sky.empty()) {
        file.write(group + "/sky", table.sky, 1, {"1", "shares of the flux from each row that leave the scene"});
        file.write(group + "/back", table.back, 1, {"1", "shares that reach backs of faces or start below a face"});
    }
    if (!table.names.empty()) file.write_texts(group + "/names", table.names, {"1", "names of rows"});
}

SparseFactors read_factor_rows(Hdf5Reader& file, const std::string& group, std::size_t further_columns) {
    const std::string in = group + "/";
    SparseFactors table;
    table.areas = file.read<double>(in + "areas");
    const std::size_t n = table.size();
    const auto starts = file.read<std::int64_t>(in + "indptr", 1, n + 1);
    const auto columns = file.read<std::int32_t>(in + "indices");
    table.values = file.read<double>(in + "data", 1, columns.size());
    table.finished = file.read<std::uint8_t>(in + "finished", 1, n);
    table.emittances = file.read<double>(in + "emittances", 1, n);
    table.row_sums = file.read<double>(in + "row_sums", 1, n);
    if (file.has(in + "row_errors")) table.row_errors = file.read<double>(in + "row_errors", 1, n);
    table.dropped = file.read<double>(in + "dropped", 1, n);
    if (file.has(in + "sky")) {
        table.sky = file.read<double>(in + "sky", 1, n);
        table.back = file.read<double>(in + "back", 1, n);
    }
    if (file.has(in + "names")) table.names = file.read_texts(in + "names", n);
    table.combined = file.integer_attribute(group, "combined").value_or(0) != 0;
    if (file.failed()) return {};
    const bool is_ascending = std::is_sorted(starts.begin(), starts.end());
    if (!is_ascending || starts.front() != 0 || starts.back() != static_cast<std::int64_t>(columns.size()))
        file.fail(in + "indptr", "does not divide the entries into rows");
    for (std::int32_t column : columns)
        if (column < 0 || static_cast<std::size_t>(column) >= n + further_columns)
            file.fail(in + "indices", "refers to a face that does not exist");
    if (file.failed()) return {};
    table.starts.assign(starts.begin(), starts.end());
    table.columns.assign(columns.begin(), columns.end());
    return table;
}

Result<void> check_file_version(Hdf5Reader& file, const std::string& group, std::int64_t known,
                                const std::string& path) {
    const std::int64_t version = file.integer_attribute(group, "version").value_or(1);
    if (version <= known) return {};
    return Error{ErrorCode::bad_input,
                 fmt::format("is of version {}; this program reads versions up to {}", version, known), path,
                 "use the program that wrote it, or compute the view factors again"};
}

}  // namespace exitance
