#include "exitance/io/view_factors/view_factor_file.hpp"

#include <algorithm>
#include <filesystem>

#include "exitance/base/check.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/io/view_factors/factor_rows_file.hpp"
#include "exitance/io/view_factors/solver_formats.hpp"
#include "exitance/io/view_factors/text_format.hpp"

namespace exitance {
namespace {

constexpr std::int64_t factors_version =  ///< Version of the .h5 format; raised if older programs cannot read the file.
    1;

Error stopped() {
    return {ErrorCode::limit, "stopped while view factors were written", "", "allow more time"};
}

class Csv : public TextFormat {
  public:
    Csv(const SparseFactors& table, bool with_sky) : TextFormat(table), with_sky_(with_sky) {}
    void begin(std::string& text) const override {
        text = "surface,area,row_sum";
        for (std::size_t j = 1; j <= table_.size(); ++j) append_formatted(text, ",F_%zu", j);
        if (with_sky_) text += ",sky,back";
        text += '\n';
    }
    void add_row(std::string& text, std::size_t i) const override {
        if (!table_.finished[i]) return;
        append_formatted(text, "%zu,%.17g,%.17g", i + 1, table_.areas[i], table_.row_sums[i]);
        for_all_columns(i, [&](double F) {
            if (F == 0)
                text += ",0";
            else
                append_exactly(text += ',', F);
        });
        if (with_sky_) append_exactly(text += ',', table_.sky[i]), append_exactly(text += ',', table_.back[i]);
        text += '\n';
    }

  private:
    bool with_sky_;
};

class Vf : public TextFormat {
  public:
    using TextFormat::TextFormat;
    void begin(std::string& text) const override {
        text = "View3D 4.0.0 0 0 0 " +
               std::to_string(table_.size());  // View3D's fields: version, output, enclosure, emittances, N
        if (text.size() < 30) text.resize(30, ' ');
        text += '\n';
        add_line(text, "%g", table_.areas);
    }
    void add_row(std::string& text, std::size_t i) const override {
        const char* separator = "";
        for_all_columns(i, [&](double F) { text += separator, append_formatted(text, "%.6f", F), separator = " "; });
        text += '\n';
    }
    void end(std::string& text) const override { add_line(text, "%.3f", table_.emittances); }

  private:
    static void add_line(std::string& text, const char* format, const std::vector<double>& values) {
        const char* separator = "";
        for (const double value : values) text += separator, append_formatted(text, format, value), separator = " ";
        text += '\n';
    }
};

class MatrixMarket : public TextFormat {
  public:
    MatrixMarket(const SparseFactors& table, bool with_sky) : TextFormat(table), with_sky_(with_sky) {}
    void begin(std::string& text) const override {
        const std::size_t n = table_.size();
        text =
            "%%MatrixMarket matrix coordinate real general\n"
            "% view factors: row i, column j is the share of the flux leaving face i that reaches face j\n"
            "% areas in m^2, a line a face:\n";
        for (std::size_t i = 0; i < n; ++i) append_formatted(text, "%% %zu %.17g\n", i + 1, table_.areas[i]);
        const auto unfinished = static_cast<std::size_t>(std::count(table_.finished.begin(), table_.finished.end(), 0));
        if (unfinished > 0) append_formatted(text, "%% %zu rows are not finished\n", unfinished);
        if (with_sky_) append_formatted(text, "%% columns %zu and %zu: sky, and backs of faces\n", n + 1, n + 2);
        append_formatted(text, "%zu %zu ", n, with_sky_ ? n + 2 : n);
        append_formatted(text, "%zu\n", table_.entries() + (with_sky_ ? 2 * n : 0));
    }
    void add_row(std::string& text, std::size_t i) const override {
        for (std::size_t k = table_.starts[i]; k < table_.starts[i + 1]; ++k) {
            append_formatted(text, "%zu %zu ", i + 1, std::size_t(table_.columns[k]) + 1);
            append_exactly(text, table_.values[k]);
            text += '\n';
        }
        if (!with_sky_) return;
        const std::size_t n = table_.size();
        append_formatted(text, "%zu %zu ", i + 1, n + 1), append_exactly(text, table_.sky[i]);
        append_formatted(text, "\n%zu %zu ", i + 1, n + 2), append_exactly(text, table_.back[i]);
        text += '\n';
    }

  private:
    bool with_sky_;
};

std::string whole_text(const TextFormat& format, std::size_t rows) {
    std::string text;
    format.begin(text);
    for (std::size_t i = 0; i < rows; ++i) format.add_row(text, i);
    format.end(text);
    return text;
}

/// Writes one row at a time, so that the text of a large table is never in memory as a whole.
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

/// Writes compressed sparse rows, with SciPy's names for their arrays.
Result<void> write_hdf5(const std::string& path, const SparseFactors& table, const FactorFileOptions& options,
                        const StopRequest& stop) {
    if (stop.requested()) return stopped();
    const std::string group = "view_factors";
    Hdf5Writer file(path);
    file.make_group(group);
    file.set_attribute(group, "format", std::string_view("csr"));
    file.set_attribute(group, "version", factors_version);
    const std::int64_t shape[] = {static_cast<std::int64_t>(table.size()), static_cast<std::int64_t>(table.size())};
    file.set_attribute(group, "shape", std::span<const std::int64_t>(shape));
    file.set_attribute(group, "combined", static_cast<std::int32_t>(table.combined));
    const double origin[] = {options.origin.x, options.origin.y, options.origin.z};
    file.set_attribute(group, "origin", std::span<const double>(origin));
    file.set_attribute(group, "reciprocity_defect", table.reciprocity_defect);
    if (table.row_errors.empty())
        file.set_attribute(group, "entry_reciprocity_defect", table.entry_defect);
    else
        file.set_attribute(group, "closure_defect", table.closure_defect);
    write_factor_rows(file, group, table);
    if (!options.row_of_face.empty())
        file.write_rows<std::int32_t>(group + "/row_of_face", options.row_of_face.size(), 1,
                                      {"1", "row of every face of the scene, from 0; -1: none"},
                                      [&](std::size_t i, std::span<std::int32_t> row) {
                                          row[0] = static_cast<std::int32_t>(options.row_of_face[i]);
                                      });
    if (!options.script_f.empty()) {
        file.write(group + "/script_f", options.script_f, table.size(),
                   {"1", "exchange factors: share of black-body power emitted by the row and absorbed by the column"});
        file.write(group + "/gebhart", options.gebhart, table.size(),
                   {"1", "Gebhart's factors: share of emitted power absorbed by the column, over all reflections"});
    }
    if (stop.requested()) return stopped();
    return file.commit();
}

}  // namespace

std::string view_factors_vf(const SparseFactors& table) {
    return whole_text(Vf(table), table.size());
}

Result<SparseFactors> read_view_factors(const std::string& path) {
    Result<Hdf5Reader> file = Hdf5Reader::open(path);
    if (!file) return file.error();
    return read_view_factors(*file, path);
}

Result<SparseFactors> read_view_factors(Hdf5Reader& file, const std::string& path) {
    if (const Result<void> known = check_file_version(file, "view_factors", factors_version, path); !known)
        return known.error();
    SparseFactors table = read_factor_rows(file, "view_factors", 0);
    if (file.failed()) return file.error();
    return table;
}

const FactorFormatTraits& traits_of(FactorFormat format) {
    const auto found = std::find_if(factor_formats.begin(), factor_formats.end(),
                                    [&](const FactorFormatTraits& traits) { return traits.format == format; });
    EXI_CHECK(found != factor_formats.end());
    return *found;
}

std::string endings_of_factor_files() {
    std::string out;
    for (const FactorFormatTraits& traits : factor_formats)
        if (!traits.ending.empty()) out.append(out.empty() ? "" : ", ").append(traits.ending);
    return out;
}

FactorFormat factor_format_of(const std::string& path) {
    const std::string end = ending(path);
    for (const FactorFormatTraits& traits : factor_formats)
        if (!end.empty() && traits.ending == end) return traits.format;
    return FactorFormat::csv;
}

Result<void> write_view_factors(const std::string& path, const SparseFactors& table, const StopRequest& stop,
                                const FactorFileOptions& options) {
    switch (options.format.value_or(factor_format_of(path))) {
        case FactorFormat::hdf5:
            return write_hdf5(path, table, options, stop);
        case FactorFormat::vf:
            return write_text(path, Vf(table), table.size(), stop);
        case FactorFormat::mtx:
            return write_text(path, MatrixMarket(table, options.with_sky), table.size(), stop);
        case FactorFormat::energyplus:
            return write_text(path, EnergyPlus(table, options.zone), table.size(), stop);
        case FactorFormat::pairs:
            return write_text(path, FactorPairs(table, options.with_sky), table.size(), stop);
        case FactorFormat::openfoam: {
            std::error_code failed;
            std::filesystem::create_directories(path, failed);
            if (failed) return Error{ErrorCode::cannot_write, "cannot be created: " + failed.message(), path, ""};
            const Result<void> first = write_text(path + "/F", OpenFoamFactors(table), table.size(), stop);
            if (!first) return first;
            return write_text(path + "/globalFaceFaces", OpenFoamColumns(table), table.size(), stop);
        }
        case FactorFormat::csv:
            break;
    }
    return write_text(path, Csv(table, options.with_sky), table.size(), stop);
}

}  // namespace exitance
