#include "exitance/lab/flatland/line_basis.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/check.hpp"

namespace exitance::flatland {
namespace {

using Rows = std::vector<std::vector<double>>;

double product(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// Returns orthonormal rows that are orthogonal to `given` (orthonormal), made from unit vectors in their order.
Rows complement(const Rows& given, std::size_t dimension) {
    Rows all = given, out;
    for (std::size_t i = 0; i < dimension && all.size() < dimension; ++i) {
        std::vector<double> row(dimension);
        row[i] = 1;
        for (int twice = 0; twice < 2; ++twice)
            for (const auto& other : all) {
                const double share = product(row, other);
                for (std::size_t j = 0; j < dimension; ++j) row[j] -= share * other[j];
            }
        const double length = std::sqrt(product(row, row));
        if (length < 1e-6) continue;
        for (double& v : row) v /= length;
        all.push_back(row);
        out.push_back(row);
    }
    return out;
}

Rows orthonormalised(Rows rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double share = product(rows[i], rows[j]);
            for (std::size_t c = 0; c < rows[i].size(); ++c) rows[i][c] -= share * rows[j][c];
        }
        const double length = std::sqrt(product(rows[i], rows[i]));
        for (double& v : rows[i]) v /= length;
    }
    return rows;
}

/// Orthonormal Legendre polynomials on [0, 1].
double legendre(std::size_t degree, double s) {
    const double x = 2 * s - 1;
    if (degree == 0) return 1;
    if (degree == 1) return std::sqrt(3.0) * x;
    return std::sqrt(5.0) * 0.5 * (3 * x * x - 1);
}

/// Coarse functions of multiwavelets in terms of fine ones: int L_i(s) sqrt(2) L_j(2 s - half) ds, exact with three
/// nodes.
Rows coarse_legendre(std::size_t k) {
    const double nodes[] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
    const double weights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    Rows rows(k, std::vector<double>(2 * k));
    for (std::size_t i = 0; i < k; ++i)
        for (std::size_t half = 0; half < 2; ++half)
            for (std::size_t j = 0; j < k; ++j)
                for (std::size_t q = 0; q < 3; ++q)
                    rows[i][half * k + j] += std::sqrt(0.5) * weights[q] * legendre(j, nodes[q]) *
                                             legendre(i, 0.5 * (nodes[q] + static_cast<double>(half)));
    return rows;
}

/// A coarse box consists of two fine ones.
Rows coarse_boxes(std::size_t k) {
    Rows rows(k, std::vector<double>(2 * k));
    for (std::size_t i = 0; i < k; ++i) rows[i][2 * i] = rows[i][2 * i + 1] = std::sqrt(0.5);
    return rows;
}

/// Moments of 2k boxes of the unit interval up to degree k - 1.
Rows box_moments(std::size_t k) {
    Rows rows(k, std::vector<double>(2 * k));
    for (std::size_t p = 0; p < k; ++p)
        for (std::size_t i = 0; i < 2 * k; ++i) {
            const double lo = static_cast<double>(i), hi = lo + 1, power = static_cast<double>(p + 1);
            rows[p][i] = (std::pow(hi, power) - std::pow(lo, power)) / power;
        }
    return rows;
}

std::vector<double> flat(const Rows& rows) {
    std::vector<double> out;
    for (const auto& row : rows) out.insert(out.end(), row.begin(), row.end());
    return out;
}

/// Inverse by Gauss-Jordan elimination with pivoting.
std::vector<double> inverse(std::vector<double> a, std::size_t n) {
    std::vector<double> out(n * n);
    for (std::size_t i = 0; i < n; ++i) out[i * n + i] = 1;
    for (std::size_t c = 0; c < n; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c; r < n; ++r)
            if (std::abs(a[r * n + c]) > std::abs(a[pivot * n + c])) pivot = r;
        EXI_CHECK(std::abs(a[pivot * n + c]) > 1e-12);  // both halves of a step together are a basis
        for (std::size_t j = 0; j < n; ++j)
            std::swap(a[c * n + j], a[pivot * n + j]), std::swap(out[c * n + j], out[pivot * n + j]);
        const double scale = 1 / a[c * n + c];
        for (std::size_t j = 0; j < n; ++j) a[c * n + j] *= scale, out[c * n + j] *= scale;
        for (std::size_t r = 0; r < n; ++r) {
            if (r == c) continue;
            const double share = a[r * n + c];
            for (std::size_t j = 0; j < n; ++j)
                a[r * n + j] -= share * a[c * n + j], out[r * n + j] -= share * out[c * n + j];
        }
    }
    return out;
}

bool is_flatlet(LineBasis basis) {
    return basis == LineBasis::flatlet2 || basis == LineBasis::flatlet3;
}
std::size_t order_of(LineBasis basis) {
    if (basis == LineBasis::haar) return 1;
    return basis == LineBasis::flatlet2 || basis == LineBasis::multiwavelet2 ? 2 : 3;
}

}  // namespace

std::string_view name_of(LineBasis basis) {
    constexpr std::string_view names[] = {"haar", "flatlet2", "flatlet3", "multiwavelet2", "multiwavelet3"};
    return names[static_cast<std::size_t>(basis)];
}

TwoScaleStep::TwoScaleStep(LineBasis basis) : k_(order_of(basis)), orthonormal_(!is_flatlet(basis)) {
    Rows rows = orthonormal_ ? coarse_legendre(k_) : coarse_boxes(k_);
    const Rows details = complement(orthonormal_ ? rows : orthonormalised(box_moments(k_)), 2 * k_);
    rows.insert(rows.end(), details.begin(), details.end());
    analysis_ = flat(rows);
    synthesis_ = inverse(analysis_, 2 * k_);
}

void TwoScaleStep::multiply(const std::vector<double>& matrix, const double* in, double* out) const {
    const std::size_t n = 2 * k_;
    for (std::size_t r = 0; r < n; ++r) {
        out[r] = 0;
        for (std::size_t c = 0; c < n; ++c) out[r] += matrix[r * n + c] * in[c];
    }
}

std::vector<double> values_on_interval(LineBasis basis, double s, double width) {
    const std::size_t k = order_of(basis);
    std::vector<double> out(k);
    if (is_flatlet(basis)) {
        const auto box = std::min(k - 1, static_cast<std::size_t>(s * static_cast<double>(k)));
        out[box] = std::sqrt(static_cast<double>(k) / width);
    } else {
        for (std::size_t i = 0; i < k; ++i) out[i] = legendre(i, s) / std::sqrt(width);
    }
    return out;
}

}  // namespace exitance::flatland
