#include "exitance/io/files/view_factor_file.hpp"

#include <charconv>
#include <cstdio>

#include "exitance/io/files/atomic_file.hpp"

namespace exitance {
namespace {

template <class... Values>
void append(std::string& text, const char* format, Values... values) {
    char buffer[64];
    const int length = std::snprintf(buffer, sizeof buffer, format, values...);
    text.append(buffer, static_cast<std::size_t>(length));
}

/// As by %.17g: no digit is lost; millions of entries are most of what writing takes.
void append_exactly(std::string& text, double value) {
    char buffer[64];
    text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 17).ptr);
}

bool ends_with_vf(const std::string& path) {
    return path.size() >= 3 && (path.ends_with(".vf") || path.ends_with(".VF"));
}

}  // namespace

std::string view_factors_csv(const ViewFactors& table) {
    const std::size_t n = table.size();
    std::string text = "surface,area,row_sum";
    text.reserve(n * n * 12 + n * 64);
    for (std::size_t j = 1; j <= n; ++j) append(text, ",F_%zu", j);
    text += '\n';
    for (std::size_t i = 0; i < n; ++i) {
        append(text, "%zu,%.17g,%.17g", i + 1, table.areas[i], table.row_sums[i]);
        for (double F : table.row(i))
            if (F == 0)
                text += ",0";
            else
                append_exactly(text += ',', F);
        text += '\n';
    }
    return text;
}

std::string view_factors_vf(const ViewFactors& table) {
    const std::size_t n = table.size();
    std::string text = "View3D 4.0.0 0 0 0 " + std::to_string(n);  // out encl emit N
    if (text.size() < 30) text.resize(30, ' ');
    text += '\n';
    text.reserve(n * n * 9 + n * 32);
    for (double area : table.areas) append(text, " %g", area);
    text += '\n';
    for (std::size_t i = 0; i < n; ++i) {
        for (double F : table.row(i)) append(text, " %.6f", F);
        text += '\n';
    }
    for (double emittance : table.emittances) append(text, " %.3f", emittance);
    text += '\n';
    return text;
}

Result<void> write_view_factors(const std::string& path, const ViewFactors& table) {
    return write_file(path, ends_with_vf(path) ? view_factors_vf(table) : view_factors_csv(table));
}

}  // namespace exitance
