#include "exitance/io/view_factors/view3d_output.hpp"

#include <fmt/format.h>

#include <cstring>

#include "exitance/io/view_factors/view_factor_file.hpp"

namespace exitance {
namespace {

constexpr std::size_t header_size = 30;  // given by View3D's format

std::string header(const SparseFactors& table, const View3dControls& controls) {
    std::string text = fmt::format("View3D 4.0.0 {} {} {} {}", controls.out, controls.is_enclosure ? 1 : 0,
                                   controls.has_emittances ? 1 : 0, table.size());
    text.resize(header_size, ' ');
    return text;
}

void add_float(std::string& bytes, double value) {
    const auto single = static_cast<float>(value);
    char raw[sizeof single];
    std::memcpy(raw, &single, sizeof single);
    bytes.append(raw, sizeof single);
}

std::string binary(const SparseFactors& table, const View3dControls& controls) {
    std::string bytes = header(table, controls) + "\r\n";
    for (const double area : table.areas) add_float(bytes, area);
    for (std::size_t i = 0; i < table.size(); ++i) {
        std::vector<double> row(table.size());
        for (std::size_t k = 0; k < table.row_columns(i).size(); ++k)
            row[table.row_columns(i)[k]] = table.row_values(i)[k];
        for (const double F : row) add_float(bytes, F);
    }
    for (const double emittance : table.emittances) add_float(bytes, emittance);
    return bytes;
}

std::string exchange_areas(const SparseFactors& table, const View3dControls& controls) {
    constexpr std::size_t numbers_a_line = 5;  // given by View3D's format
    std::string text =
        header(table, controls) + fmt::format("\nT {}\n", controls.title) + "!  #     area          emit    name\n";
    for (std::size_t i = 0; i < table.size(); ++i) {
        text += fmt::format("{:4} {:14.6e} {:7.3f}   {}\n", i + 1, table.areas[i], table.emittances[i],
                            i < table.names.size() ? table.names[i] : "");
        std::size_t k = table.starts[i];
        for (std::size_t j = 0; j <= i; ++j) {
            const bool has_entry = k < table.starts[i + 1] && table.columns[k] == j;
            text += fmt::format("{:14.6e}", has_entry ? table.areas[i] * table.values[k++] : 0.0);
            text += (j + 1) % numbers_a_line == 0 ? '\n' : ' ';
        }
        if ((i + 1) % numbers_a_line != 0) text += '\n';
    }
    return text + '\n';
}

}  // namespace

Result<std::string> view3d_output(const SparseFactors& table, const View3dControls& controls) {
    if (controls.out == 1) return binary(table, controls);
    if (controls.out == 2) return exchange_areas(table, controls);
    if (controls.out != 0)
        return Error{ErrorCode::bad_input, fmt::format("View3D has no format out={}", controls.out), "",
                     "use out=0 (text), out=1 (binary) or out=2 (exchange areas), or `exitance viewfactors --format`"};
    std::string text = view_factors_vf(table);
    return text.replace(0, header_size, header(table, controls));
}

}  // namespace exitance
