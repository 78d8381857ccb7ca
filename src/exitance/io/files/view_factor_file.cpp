#include "exitance/io/files/view_factor_file.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/solution/hdf5_file.hpp"

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

Error stopped() {
    return {ErrorCode::limit, "stopped while view factors were written", "", "allow more time"};
}

/// A format of text: what comes before the rows, each row, and what comes after them.
class TextFormat {
  public:
    explicit TextFormat(const ViewFactors& table) : table_(table) {}
    virtual ~TextFormat() = default;
    virtual void begin(std::string& text) const = 0;
    virtual void add_row(std::string& text, std::size_t i) const = 0;
    virtual void end(std::string& /*text*/) const {}

  protected:
    const ViewFactors& table_;
};

class Csv : public TextFormat {
  public:
    using TextFormat::TextFormat;
    void begin(std::string& text) const override {
        text = "surface,area,row_sum";
        for (std::size_t j = 1; j <= table_.size(); ++j) append(text, ",F_%zu", j);
        text += '\n';
    }
    void add_row(std::string& text, std::size_t i) const override {
        append(text, "%zu,%.17g,%.17g", i + 1, table_.areas[i], table_.row_sums[i]);
        for (double F : table_.row(i))
            if (F == 0)
                text += ",0";
            else
                append_exactly(text += ',', F);
        text += '\n';
    }
};

class Vf : public TextFormat {
  public:
    using TextFormat::TextFormat;
    void begin(std::string& text) const override {
        text = "View3D 4.0.0 0 0 0 " + std::to_string(table_.size());  // out encl emit N
        if (text.size() < 30) text.resize(30, ' ');
        text += '\n';
        for (double area : table_.areas) append(text, " %g", area);
        text += '\n';
    }
    void add_row(std::string& text, std::size_t i) const override {
        for (double F : table_.row(i)) append(text, " %.6f", F);
        text += '\n';
    }
    void end(std::string& text) const override {
        for (double emittance : table_.emittances) append(text, " %.3f", emittance);
        text += '\n';
    }
};

class MatrixMarket : public TextFormat {
  public:
    using TextFormat::TextFormat;
    void begin(std::string& text) const override {
        const std::size_t n = table_.size();
        text =
            "%%MatrixMarket matrix coordinate real general\n"
            "% view factors: row i, column j is the share of the flux leaving face i that reaches face j\n"
            "% areas in m^2, a line a face:\n";
        for (std::size_t i = 0; i < n; ++i) append(text, "%% %zu %.17g\n", i + 1, table_.areas[i]);
        const auto zeros = std::count(table_.factors.begin(), table_.factors.end(), 0.0);
        append(text, "%zu %zu ", n, n);
        append(text, "%zu\n", table_.factors.size() - static_cast<std::size_t>(zeros));
    }
    void add_row(std::string& text, std::size_t i) const override {
        const std::span<const double> row = table_.row(i);
        for (std::size_t j = 0; j < row.size(); ++j) {
            if (row[j] == 0) continue;
            append(text, "%zu %zu ", i + 1, j + 1);
            append_exactly(text, row[j]);
            text += '\n';
        }
    }
};

std::string whole_text(const TextFormat& format, std::size_t rows) {
    std::string text;
    format.begin(text);
    for (std::size_t i = 0; i < rows; ++i) format.add_row(text, i);
    format.end(text);
    return text;
}

/// A row at a time: a large table is never held as text.
Result<void> write_text(const std::string& path, const TextFormat& format, std::size_t rows, const StopRequest& stop) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    std::string text;
    format.begin(text);
    for (std::size_t i = 0; i < rows; ++i) {
        format.add_row(text, i);
        file->write(text);
        text.clear();
        if (stop.requested()) return stopped();
    }
    format.end(text);
    file->write(text);
    if (stop.requested()) return stopped();
    return file->commit();
}

/// Compressed rows, by the names that SciPy gives their parts.
Result<void> write_hdf5(const std::string& path, const ViewFactors& table, const StopRequest& stop) {
    const std::size_t n = table.size();
    std::vector<std::int64_t> starts{0};
    std::vector<std::int32_t> columns;
    std::vector<double> values;
    for (std::size_t i = 0; i < n; ++i) {
        const std::span<const double> row = table.row(i);
        for (std::size_t j = 0; j < n; ++j)
            if (row[j] != 0) columns.push_back(static_cast<std::int32_t>(j)), values.push_back(row[j]);
        starts.push_back(static_cast<std::int64_t>(values.size()));
        if (stop.requested()) return stopped();
    }
    const std::string group = "view_factors";
    Hdf5Writer file(path);
    file.make_group(group);
    file.set_attribute(group, "format", std::string_view("csr"));
    const std::int64_t shape[] = {static_cast<std::int64_t>(n), static_cast<std::int64_t>(n)};
    file.set_attribute(group, "shape", std::span<const std::int64_t>(shape));
    file.set_attribute(group, "reciprocity_defect", table.reciprocity_defect);
    file.set_attribute(group, "entry_reciprocity_defect", table.entry_defect);
    file.write(group + "/indptr", starts, 1, {"1", "where rows begin in data, and the end"});
    file.write(group + "/indices", columns, 1, {"1", "columns of data, from 0"});
    file.write(group + "/data", values, 1, {"1", "view factors from the row's face to the column's"});
    file.write(group + "/areas", table.areas, 1, {"m^2", "areas of faces"});
    file.write(group + "/emittances", table.emittances, 1, {"1", "emittances of faces"});
    file.write(group + "/row_sums", table.row_sums, 1, {"1", "sums of rows"});
    if (stop.requested()) return stopped();
    return file.commit();
}

}  // namespace

std::string view_factors_csv(const ViewFactors& table) {
    return whole_text(Csv(table), table.size());
}

std::string view_factors_vf(const ViewFactors& table) {
    return whole_text(Vf(table), table.size());
}

std::string view_factors_mtx(const ViewFactors& table) {
    return whole_text(MatrixMarket(table), table.size());
}

Result<void> write_view_factors(const std::string& path, const ViewFactors& table, const StopRequest& stop) {
    const std::string end = ending(path);
    if (end == ".h5") return write_hdf5(path, table, stop);
    if (end == ".vf") return write_text(path, Vf(table), table.size(), stop);
    if (end == ".mtx") return write_text(path, MatrixMarket(table), table.size(), stop);
    return write_text(path, Csv(table), table.size(), stop);
}

}  // namespace exitance
