#include "exitance/io/files/probe_file.hpp"

#include <charconv>
#include <cmath>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/honeybee/honeybee_model.hpp"

namespace exitance {
namespace {

std::vector<std::string> band_columns(const std::string& prefix) {
    std::vector<std::string> names;
    for (std::size_t b = 0; b < bands; ++b) names.push_back(prefix + band_name(b));
    return names;
}

const std::vector<std::string>& place_columns() {
    static const std::vector<std::string> names = {"x", "y", "z", "nx", "ny", "nz"};
    return names;
}

/// Scales `v` to length 1; empty if it has no direction. A vector that already has that length keeps its digits.
std::optional<Normal> unit(const Vec3& v) {
    const double length = norm(v);
    if (!(length > 1e-100) || !std::isfinite(length)) return {};
    return std::abs(length - 1) < 1e-11 ? v : v / length;
}

constexpr const char* no_direction = "the normal has no direction";

/// Text buffer for one row, large enough for all its numbers (at most 24 characters each).
class Row {
  public:
    void exact(double value) { end_ = std::to_chars(end_, limit(), value).ptr, *end_++ = ','; }
    void rounded(double value) {
        end_ = std::to_chars(end_, limit(), value, std::chars_format::general, 10).ptr, *end_++ = ',';
    }
    void empty() { *end_++ = ','; }
    std::string_view line() { return end_[-1] = '\n', std::string_view(text_, static_cast<std::size_t>(end_ - text_)); }

  private:
    char* limit() { return text_ + sizeof text_ - 1; }
    char text_[32 * (6 + 3 * bands)];
    char* end_ = text_;
};

}  // namespace

std::string band_name(std::size_t band) {
    if constexpr (bands == 3) return std::string(1, "rgb"[band]);
    return std::to_string(band + 1);
}

Result<ProbeReader> ProbeReader::open_model(const std::string& path) {
    const HoneybeeModel model = read_honeybee_model(path);
    if (const std::optional<Error> error = model.first_error(path)) return *error;
    ProbePoints sensors;
    for (const HoneybeeGrid& grid : model.grids) {
        sensors.points.insert(sensors.points.end(), grid.points.begin(), grid.points.end());
        sensors.normals.insert(sensors.normals.end(), grid.normals.begin(), grid.normals.end());
    }
    if (sensors.size() == 0)
        return Error{ErrorCode::bad_input, "holds no sensor grids", path,
                     "add a grid to the model, or name a table of points"};
    return ProbeReader(std::move(sensors));
}

Result<ProbeReader> ProbeReader::open(const std::string& path) {
    if (is_honeybee_file(path)) return open_model(path);
    Result<LineReader> lines = LineReader::open(path);
    if (!lines) return lines.error();
    const auto first = lines->next_content();
    if (lines->failed()) return lines->read_error();
    if (!first) return lines->error("holds no points", "begin with the header x,y,z,nx,ny,nz");
    std::string copy(*first);
    const bool number = copy.find_first_of("0123456789") == copy.find_first_not_of(" \t+-.");
    if (path.ends_with(".pts") || (number && copy.find(',') == std::string::npos))
        return ProbeReader(std::move(*lines), std::move(copy));
    Result<NumberTable> table = NumberTable::open(std::move(*lines), copy, place_columns());
    if (!table) return table.error();
    return ProbeReader(std::move(*table));
}

Result<bool> ProbeReader::next_row(std::array<double, 6>& row) {
    if (table_) return table_->next(row);
    if (!first_) {
        const auto line = lines_->next_content();
        if (lines_->failed()) return lines_->read_error();
        if (!line) return false;
        first_ = *line;
    }
    std::string_view rest = *first_;
    for (double& value : row) {
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t,"), rest.size()));
        const std::size_t end = std::min(rest.find_first_of(" \t,"), rest.size());
        const std::optional<double> number = parse_number(rest.substr(0, end));
        if (!number || !std::isfinite(*number))
            return lines_->error("the line does not begin with six numbers", "a line is x y z dx dy dz");
        value = *number;
        rest.remove_prefix(end);
    }
    first_.reset();
    return true;
}

Result<void> ProbeReader::next(ProbePoints& out, std::size_t most) {
    out.points.clear(), out.normals.clear();
    if (sensors_) {
        for (; next_sensor_ < sensors_->size() && out.size() < most; ++next_sensor_) {
            out.points.push_back(sensors_->points[next_sensor_]);
            out.normals.push_back(sensors_->normals[next_sensor_]);
        }
        return {};
    }
    std::array<double, 6> row;
    while (out.size() < most) {
        const Result<bool> more = next_row(row);
        if (!more) return more.error();
        if (!*more) break;
        const std::optional<Normal> n = unit({row[3], row[4], row[5]});
        if (!n) return (table_ ? table_->lines() : *lines_).error(no_direction);
        out.points.push_back({row[0], row[1], row[2]});
        out.normals.push_back(*n);
    }
    return {};
}

Result<ProbePoints> load_probe_points(const std::string& path) {
    Result<ProbeReader> reader = ProbeReader::open(path);
    if (!reader) return reader.error();
    ProbePoints out;
    const Result<void> read = reader->next(out, std::size_t(-1));
    if (!read) return read.error();
    return out;
}

Result<ProbeReference> load_probe_reference(const std::string& path) {
    std::vector<std::string> required = place_columns();
    for (std::string& name : band_columns("E_")) required.push_back(std::move(name));
    Result<NumberTable> table = NumberTable::open(path, required, band_columns("se_"));
    if (!table) return table.error();
    ProbeReference out;
    bool with_errors = true;
    for (std::size_t b = 0; b < bands; ++b) with_errors = with_errors && table->has(b);
    std::array<double, 6 + 2 * bands> row;
    for (;;) {
        const Result<bool> more = table->next(row);
        if (!more) return more.error();
        if (!*more) break;
        const std::optional<Normal> n = unit({row[3], row[4], row[5]});
        if (!n) return table->lines().error(no_direction);
        Spectrum irradiance, error;
        for (std::size_t b = 0; b < bands; ++b) {
            irradiance[b] = row[6 + b];
            error[b] = std::isnan(row[6 + bands + b]) ? 0 : row[6 + bands + b];
        }
        out.probes.points.push_back({row[0], row[1], row[2]});
        out.probes.normals.push_back(*n);
        out.irradiance.push_back(irradiance);
        if (with_errors) out.standard_errors.push_back(error);
    }
    if (out.irradiance.empty()) return table->lines().error("holds no points");
    return out;
}

Result<ProbeWriter> ProbeWriter::create(const std::string& path, Columns columns) {
    Result<AtomicFile> file = path == "-" ? AtomicFile::standard_output() : AtomicFile::create(path);
    if (!file) return file.error();
    std::vector<std::string> names = place_columns();
    const auto add = [&](const std::string& prefix) {
        for (std::string& name : band_columns(prefix)) names.push_back(std::move(name));
    };
    add("E_");
    if (columns.radiosity) add("B_");
    if (columns.standard_errors) add("se_");
    if (columns.unit) names.push_back(columns.unit->is_lux() ? "lux" : "watt");
    std::string header;
    for (const std::string& name : names) header += (header.empty() ? "" : ",") + name;
    file->write(header + "\n");
    return ProbeWriter(std::move(*file), columns);
}

void ProbeWriter::add(const Point& x, const Normal& n, const Spectrum& irradiance,
                      const std::optional<Spectrum>& radiosity, const Spectrum& standard_error) {
    Row row;
    for (double value : {x.x, x.y, x.z, n.x, n.y, n.z}) row.exact(value);
    for (double value : irradiance.value) row.rounded(value);
    if (columns_.radiosity)
        for (std::size_t b = 0; b < bands; ++b) radiosity ? row.rounded((*radiosity)[b]) : row.empty();
    if (columns_.standard_errors)
        for (double value : standard_error.value) row.rounded(value);
    if (columns_.unit) row.rounded((*columns_.unit)(irradiance));
    file_.write(row.line());
}

}  // namespace exitance
