#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/io/solution/hdf5_file.hpp"

namespace exitance {

/// Coordinates in a row: x, y, z of each point.
inline std::vector<double> flat(const std::vector<Point>& points) {
    std::vector<double> out;
    out.reserve(3 * points.size());
    for (const Point& p : points) out.insert(out.end(), {p.x, p.y, p.z});
    return out;
}

/// One column of a pool, with the type of the file.
template <class T, class Pool, class Get>
std::vector<T> column(const Pool& pool, const Get& get) {
    std::vector<T> out;
    out.reserve(pool.size());
    for (const auto& item : pool) out.push_back(static_cast<T>(get(item)));
    return out;
}

template <class Pool, class Get>
std::vector<double> spectra(const Pool& pool, const Get& get) {
    std::vector<double> out;
    for (const auto& item : pool) {
        const Spectrum s = get(item);
        out.insert(out.end(), s.value.begin(), s.value.end());
    }
    return out;
}

/// Reads columns of a group and validates them.
class Columns {
  public:
    Columns(Hdf5Reader& file, const std::string& group) : file_(file), group_(group + "/") {}

    template <class T>
    std::vector<T> read(const char* name, std::size_t columns = 1, std::optional<std::size_t> rows = {}) {
        std::vector<T> values = file_.read<T>(group_ + name, columns, rows);
        if constexpr (std::is_floating_point_v<T>)
            for (T value : values)
                if (!std::isfinite(value))
                    return file_.fail(group_ + name, "holds a number that is not finite"), std::vector<T>();
        return values;
    }
    std::vector<std::uint32_t> indices(const char* name, std::size_t below, std::optional<std::size_t> rows = {}) {
        std::vector<std::uint32_t> values = read<std::uint32_t>(name, 1, rows);
        for (std::uint32_t value : values)
            if (value >= below)
                return file_.fail(group_ + name,
                                  "holds " + std::to_string(value) + ", not below " + std::to_string(below)),
                       std::vector<std::uint32_t>();
        return values;
    }
    /// Reads counts that must add up to `sum`, each at least `least`.
    std::vector<std::uint32_t> counts(const char* name, std::size_t least, std::size_t sum,
                                      std::optional<std::size_t> rows = {}) {
        std::vector<std::uint32_t> values = read<std::uint32_t>(name, 1, rows);
        std::size_t total = 0;
        bool enough = true;
        for (std::uint32_t value : values) total += value, enough = enough && value >= least;
        if (!file_.failed() && (total != sum || !enough))
            return file_.fail(group_ + name, "holds counts that do not fit the sets they count"),
                   std::vector<std::uint32_t>();
        return values;
    }
    std::vector<Point> points(const char* name, std::optional<std::size_t> rows = {}) {
        const std::vector<double> values = read<double>(name, 3, rows);
        std::vector<Point> out(values.size() / 3);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
        return out;
    }
    std::vector<Normal> normals(const char* name, std::size_t rows) {
        std::vector<Normal> out = points(name, rows);
        for (const Normal& n : out)
            if (std::abs(norm(n) - 1) > 1e-6)
                return file_.fail(group_ + name, "holds a normal whose length is not 1"), out;
        return out;
    }

  private:
    Hdf5Reader& file_;
    std::string group_;
};

/// Returns a row of a data set with one column per band.
inline Spectrum spectrum(const std::vector<double>& values, std::size_t row) {
    Spectrum s;
    for (std::size_t b = 0; b < bands; ++b) s[b] = values[row * bands + b];
    return s;
}

}  // namespace exitance
