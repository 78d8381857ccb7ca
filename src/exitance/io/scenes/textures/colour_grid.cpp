#include "exitance/io/scenes/textures/colour_grid.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// Index of the interval of ascending `borders` that contains a value; values outside belong to the nearest one.
std::size_t interval_of(std::span<const double> borders, double value) {
    const auto after = std::upper_bound(borders.begin(), borders.end(), value) - borders.begin();
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after - 1, 0, std::ssize(borders) - 2));
}

/// Splits the segment p q at those borders that are between its ends, along x if `along_x`, else along y, and calls
/// visit(interval, from, to) for each part.
template <class Visit>
void split_segment(const Vec2& p, const Vec2& q, bool along_x, std::span<const double> borders, Visit&& visit) {
    const double from = along_x ? p.x : p.y, to = along_x ? q.x : q.y;
    const bool ascends = from <= to;
    std::size_t i = interval_of(borders, from);
    const std::size_t last = interval_of(borders, to);
    Vec2 at = p;
    while (i != last) {
        const double border = borders[ascends ? i + 1 : i];
        const double t = std::clamp((border - from) / (to - from), 0.0, 1.0);
        const Vec2 next = p + t * (q - p);
        visit(i, at, next);
        at = next;
        i = ascends ? i + 1 : i - 1;
    }
    visit(i, at, q);
}

double signed_area(std::span<const Vec2> polygon) {
    double sum = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        sum += 0.5 * cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    return sum;
}

}  // namespace

std::vector<double> covered_areas(std::span<const std::vector<Vec2>> polygons, std::span<const double> columns,
                                  std::span<const double> rows) {
    const std::size_t nx = columns.size() - 1, ny = rows.size() - 1;
    // `right`: per cell, the heights of edges, which count for all cells to the right
    std::vector<double> area(nx * ny), right(nx * ny);
    for (const std::vector<Vec2>& polygon : polygons) {
        const double sign = signed_area(polygon) > 0 ? -1 : 1;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Vec2 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
            split_segment(p, q, false, rows, [&](std::size_t j, const Vec2& a, const Vec2& b) {
                split_segment(a, b, true, columns, [&](std::size_t i, const Vec2& c, const Vec2& d) {
                    const double height = sign * (d.y - c.y);
                    area[j * nx + i] += height * (columns[i + 1] - 0.5 * (c.x + d.x));
                    if (i + 1 < nx) right[j * nx + i + 1] += height;
                });
            });
        }
    }
    for (std::size_t j = 0; j < ny; ++j) {
        double height = 0;
        for (std::size_t i = 0; i < nx; ++i) {
            height += right[j * nx + i];
            area[j * nx + i] = std::max(0.0, area[j * nx + i] + height * (columns[i + 1] - columns[i]));
        }
    }
    return area;
}

ColourGrid::ColourGrid(std::vector<double> columns, std::vector<double> rows, std::span<const Cell> cells, bool emits)
    : columns_(std::move(columns)),
      rows_(std::move(rows)),
      emits_(emits),
      count_(emits ? max_sums : 2 + bands),
      table_(columns_.size() * rows_.size() * count_) {
    const std::size_t nx = columns_.size() - 1;
    for (std::size_t j = 0; j + 1 < rows_.size(); ++j) {
        Sums row{};
        for (std::size_t i = 0; i < nx; ++i) {
            const Cell& cell = cells[j * nx + i];
            const double opaque = cell.area * cell.coverage;
            row[0] += cell.area, row[1] += opaque;
            for (std::size_t b = 0; b < bands; ++b) {
                const double r = cell.reflectance[b], m = cell.exitance[b];
                row[2 + b] += opaque * r, row[2 + bands + b] += opaque * m;
            }
            double* out = table_.data() + ((j + 1) * columns_.size() + i + 1) * count_;
            for (std::size_t k = 0; k < count_; ++k) out[k] = at(i + 1, j)[k] + row[k];
        }
    }
}

ColourGrid::Sums ColourGrid::sums(const GridBox& box) const {
    Sums out{};
    for (std::size_t k = 0; k < count_; ++k)
        out[k] = (at(box.i1, box.j1)[k] - at(box.i0, box.j1)[k]) - (at(box.i1, box.j0)[k] - at(box.i0, box.j0)[k]);
    return out;
}

ColourGrid::Cell ColourGrid::mean(const GridBox& box) const {
    const Sums s = sums(box);
    Cell out;
    // Less than this share of the whole is the rounding error of an uncovered box.
    constexpr double rounding = 1e-12;  // derived from the rounding of sums in double precision
    const double least = rounding * at(columns_.size() - 1, rows_.size() - 1)[0];
    if (!(s[0] > least)) return out;
    out.area = s[0], out.coverage = s[1] > least ? std::min(1.0, s[1] / s[0]) : 0;
    if (out.coverage == 0) return out;
    for (std::size_t b = 0; b < bands; ++b)
        out.reflectance[b] = std::max(0.0, s[2 + b] / s[1]), out.exitance[b] = std::max(0.0, s[2 + bands + b] / s[1]);
    return out;
}

PartColour ColourGrid::colour(const GridBox& box) const {
    // The variation of whole faces is measured at 32 x 32 points; finer variation counts by its mean here, too.
    constexpr std::size_t blocks_per_side = 32;  // derived from TextureArea::part(), which has 32 x 32 points
    const auto block_of = [](std::size_t cells) { return (cells + blocks_per_side - 1) / blocks_per_side; };
    const std::size_t wide = block_of(columns_.size() - 1), high = block_of(rows_.size() - 1);
    const Cell whole = mean(box);
    PartColour out{{whole.reflectance, {}, whole.reflectance, whole.reflectance},
                   {whole.exitance, {}, whole.exitance, whole.exitance},
                   whole.coverage};
    const double opaque = whole.area * whole.coverage;
    const auto add = [&](ColourRange& range, const Spectrum& value, double area) {
        for (std::size_t b = 0; b < bands; ++b) {
            const double difference = value[b] - range.mean[b];
            range.deviation[b] += area * difference * difference;
            range.lowest[b] = std::min(range.lowest[b], value[b]);
            range.highest[b] = std::max(range.highest[b], value[b]);
        }
    };
    for (std::size_t j = box.j0; j < box.j1; j = (j / high + 1) * high)
        for (std::size_t i = box.i0; i < box.i1; i = (i / wide + 1) * wide) {
            const Cell block =
                mean({i, std::min(box.i1, (i / wide + 1) * wide), j, std::min(box.j1, (j / high + 1) * high)});
            const double area = block.area * block.coverage;
            if (!(area > 0)) continue;
            add(out.reflectance, block.reflectance, area), add(out.exitance, block.exitance, area);
        }
    for (ColourRange* range : {&out.reflectance, &out.exitance})
        for (std::size_t b = 0; b < bands; ++b) {
            // Even colours would get a deviation from the rounding error of sums.
            constexpr double rounding = 1e-9;  // derived from the rounding of sums in double precision
            const bool is_even = range->highest[b] - range->lowest[b] <= rounding * range->highest[b];
            range->deviation[b] = is_even || !(opaque > 0) ? 0 : std::sqrt(range->deviation[b] / opaque);
        }
    return out;
}

}  // namespace exitance
