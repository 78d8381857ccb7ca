#include "exitance/view_factors/pooled_row.hpp"

namespace exitance {
namespace {

/// Weight of the first of two estimates.
double share_of(double density, double other) {
    if (density == other) return 0.5;  // also the case if both are integrated, i.e. infinite
    return std::isinf(density) ? 1 : std::isinf(other) ? 0 : density / (density + other);
}

RowEntry pooled(const RowEntry& a, const RowEntry& b) {
    const double s = share_of(double(a.density), double(b.density)), t = 1 - s;
    RowEntry out = a;
    out.F = s * a.F + t * b.F;
    out.variance = static_cast<float>(s * s * double(a.variance) + t * t * double(b.variance));
    out.density = a.density + b.density;
    return out;
}

/// An entry of a row that has none for this column: no cast ray hit that face.
RowEntry absent(const RawRow& row, std::uint32_t column) {
    return {.column = column, .density = static_cast<float>(row.cast_density)};
}

}  // namespace

RawRow pooled(const RawRow& a, const RawRow& b) {
    RawRow out;
    out.face = a.face, out.round = a.round;
    out.rays = a.rays + b.rays, out.cast_rays = a.cast_rays + b.cast_rays;
    out.cast_density = a.cast_density + b.cast_density;
    out.bound = a.bound == b.bound ? a.bound : a.bound + b.bound;
    const double s = share_of(static_cast<double>(a.cast_rays), static_cast<double>(b.cast_rays)), t = 1 - s;
    out.sky = s * a.sky + t * b.sky, out.back = s * a.back + t * b.back;
    out.sky_variance = s * s * a.sky_variance + t * t * b.sky_variance;
    out.back_variance = s * s * a.back_variance + t * t * b.back_variance;
    out.missed_variance = s * s * a.missed_variance + t * t * b.missed_variance;
    auto x = a.entries.begin(), y = b.entries.begin();
    while (x != a.entries.end() || y != b.entries.end()) {
        if (y == b.entries.end() || (x != a.entries.end() && x->column < y->column)) {
            out.entries.push_back(pooled(*x, absent(b, x->column))), ++x;
        } else if (x == a.entries.end() || y->column < x->column) {
            out.entries.push_back(pooled(absent(a, y->column), *y)), ++y;
        } else {
            out.entries.push_back(pooled(*x, *y)), ++x, ++y;
        }
    }
    return out;
}

}  // namespace exitance
