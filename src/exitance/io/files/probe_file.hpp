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

/// Where irradiance is asked for. Metres; normals of length 1.
struct ProbePoints {
    std::vector<Point> points;
    std::vector<Normal> normals;

    std::size_t size() const { return points.size(); }
};

/// Points as they come from a file, some at a time: CSV with the header x,y,z,nx,ny,nz (in any order, among other
/// columns), or, when the name ends in .pts or the text begins with a number, "x y z dx dy dz" a line. "-" is standard
/// input. Normals of another length are brought to 1; one without direction is an error.
class ProbeReader {
  public:
    static Result<ProbeReader> open(const std::string& path);

    /// Replaces `out` by up to `most` further points; none are left when it stays empty.
    Result<void> next(ProbePoints& out, std::size_t most);

  private:
    explicit ProbeReader(NumberTable table) : table_(std::move(table)) {}
    explicit ProbeReader(LineReader lines, std::string first) : lines_(std::move(lines)), first_(std::move(first)) {}
    Result<bool> next_row(std::array<double, 6>& row);

    std::optional<NumberTable> table_;  ///< Of a CSV file.
    std::optional<LineReader> lines_;   ///< Of a file of plain lines.
    std::optional<std::string> first_;  ///< A plain line already read.
};

/// All points of a file.
Result<ProbePoints> load_probe_points(const std::string& path);

/// Points with known irradiance, as references have them.
struct ProbeReference {
    ProbePoints probes;
    std::vector<Spectrum> irradiance;       ///< W/m^2
    std::vector<Spectrum> standard_errors;  ///< W/m^2; empty when the file has none.
};

/// Reads a CSV with x,y,z,nx,ny,nz, E_* and, where given, se_*.
Result<ProbeReference> load_probe_reference(const std::string& path);

/// Writes a CSV with the columns x,y,z,nx,ny,nz, E_*, then B_* (unless left out), then se_* (when asked for), a row a
/// point; "-" is standard output. Coordinates as they were read, light with 10 significant digits.
class ProbeWriter {
  public:
    struct Columns {
        bool radiosity = true;
        bool standard_errors = false;
        /// Irradiance as one number in a last column, `lux` or `watt`.
        std::optional<LightUnit> unit = {};
    };
    static Result<ProbeWriter> create(const std::string& path, Columns columns);

    /// `radiosity` is nothing for a point in free space: its fields stay empty.
    void add(const Point& x, const Normal& n, const Spectrum& irradiance, const std::optional<Spectrum>& radiosity = {},
             const Spectrum& standard_error = {});
    Result<void> commit() { return file_.commit(); }

  private:
    ProbeWriter(AtomicFile file, Columns columns) : file_(std::move(file)), columns_(columns) {}

    AtomicFile file_;
    Columns columns_;
};

/// What a band is called in column names: r, g, b where there are three, else 1, 2, ...
std::string band_name(std::size_t band);

}  // namespace exitance
