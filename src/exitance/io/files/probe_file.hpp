#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

/// Points at which irradiance is evaluated: positions in metres and unit normals.
struct ProbePoints {
    std::vector<Point> points;
    std::vector<Normal> normals;

    std::size_t size() const { return points.size(); }
};

/// Reads probe points from a file, in batches. A CSV file has the columns x,y,z,nx,ny,nz, in any order, among other
/// columns. If the name ends in .pts or the text begins with a number, the file has lines "x y z dx dy dz". "-" is
/// standard input. Normals are scaled to length 1; a normal without a direction is an error.
class ProbeReader {
  public:
    static Result<ProbeReader> open(const std::string& path);

    /// Replaces `out` by the next points, at most `most`. It is empty at the end of the file.
    Result<void> next(ProbePoints& out, std::size_t most);

  private:
    explicit ProbeReader(NumberTable table) : table_(std::move(table)) {}
    explicit ProbeReader(LineReader lines, std::string first) : lines_(std::move(lines)), first_(std::move(first)) {}
    explicit ProbeReader(ProbePoints sensors) : sensors_(std::move(sensors)) {}
    static Result<ProbeReader> open_model(const std::string& path);
    Result<bool> next_row(std::array<double, 6>& row);

    std::optional<NumberTable> table_;    ///< Open table, if the file is a CSV file.
    std::optional<LineReader> lines_;     ///< Open file, if it has plain lines.
    std::optional<std::string> first_;    ///< First plain line, read when the format was detected.
    std::optional<ProbePoints> sensors_;  ///< Points, if the file is a Honeybee model.
    std::size_t next_sensor_ = 0;
};

/// Reads all points of a file.
Result<ProbePoints> load_probe_points(const std::string& path);

/// Points with known irradiance, from a reference solution.
struct ProbeReference {
    ProbePoints probes;
    std::vector<Spectrum> irradiance;       ///< W/m^2
    std::vector<Spectrum> standard_errors;  ///< Standard errors, W/m^2; empty if the file has none.
};

/// Reads reference points from a CSV file with the columns x,y,z,nx,ny,nz, E_* and, optionally, se_*.
Result<ProbeReference> load_probe_reference(const std::string& path);

/// Writes a CSV file with the columns x,y,z,nx,ny,nz, E_*, then B_* (optional), then se_* (optional), one row per
/// point. "-" is standard output. Coordinates are written exactly, light with 10 significant digits.
class ProbeWriter {
  public:
    struct Columns {
        bool radiosity = true;
        bool standard_errors = false;
        /// Adds a last column with irradiance as one number, in `lux` or `watt`.
        std::optional<LightUnit> unit = {};
    };
    static Result<ProbeWriter> create(const std::string& path, Columns columns);

    /// Writes a row. `radiosity` is empty for a point in free space: its fields stay empty.
    void add(const Point& x, const Normal& n, const Spectrum& irradiance, const std::optional<Spectrum>& radiosity = {},
             const Spectrum& standard_error = {});
    Result<void> commit() { return file_.commit(); }

  private:
    ProbeWriter(AtomicFile file, Columns columns) : file_(std::move(file)), columns_(columns) {}

    AtomicFile file_;
    Columns columns_;
};

/// Returns the name of a band in column names: r, g, b if there are three bands, else 1, 2, ...
std::string band_name(std::size_t band);

}  // namespace exitance
