#include "exitance/lab/flatland/kernel_terms.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "exitance/base/quadrature.hpp"

namespace exitance::flatland {
namespace {

std::vector<double> project(LineBasis basis, std::size_t k, std::size_t intervals,
                            const std::function<double(double, double)>& f) {
    struct Node {
        double at, weight;
        std::vector<double> values;
    };
    const double width = 1 / static_cast<double>(intervals);
    std::vector<Node> nodes;  // quadrature nodes, three per box of an interval
    const LineRule rule = gauss_legendre(3);
    for (std::size_t box = 0; box < k; ++box)
        for (std::size_t q = 0; q < rule.size(); ++q) {
            const double s = (static_cast<double>(box) + rule.nodes[q]) / static_cast<double>(k);
            nodes.push_back(
                {s * width, rule.weights[q] * width / static_cast<double>(k), values_on_interval(basis, s, width)});
        }
    const std::size_t side = k * intervals;
    std::vector<double> out(side * side);
    for (std::size_t i = 0; i < intervals; ++i)
        for (std::size_t j = 0; j < intervals; ++j)
            for (const Node& p : nodes)
                for (const Node& q : nodes) {
                    const double value =
                        p.weight * q.weight *
                        f(static_cast<double>(i) * width + p.at, static_cast<double>(j) * width + q.at);
                    for (std::size_t a = 0; a < k; ++a)
                        for (std::size_t b = 0; b < k; ++b)
                            out[(i * k + a) * side + j * k + b] += value * p.values[a] * q.values[b];
                }
    return out;
}

}  // namespace

KernelTerms::KernelTerms(LineBasis basis, Decomposition way, int levels, const std::function<double(double, double)>& k)
    : step_(basis), way_(way) {
    const std::size_t wanted = std::size_t(1) << levels;
    intervals_ = std::bit_ceil((wanted + step_.order() - 1) / step_.order());
    side_ = step_.order() * intervals_;
    finest_ = project(basis, step_.order(), intervals_, k);
    terms_ = decompose(finest_);
    detail_norm_.assign(side_, 1), coarse_norm_.assign(side_, 1);
    if (!step_.is_orthonormal()) measure_norms();
}

/// Norm of the function that a coefficient of level `n` multiplies, by synthesis down to the finest space.
double KernelTerms::norm_of_function(std::size_t n, std::size_t which) const {
    const std::size_t k = step_.order();
    std::vector<double> line(side_), out(side_);
    line[which < k ? which : n * k + which - k] = 1;
    for (std::size_t level = n; level < intervals_; level *= 2) {
        for (std::size_t i = 0; i < level; ++i) {
            double in[6] = {}, fine[6];
            std::copy_n(&line[i * k], k, in);
            if (level == n) std::copy_n(&line[(level + i) * k], k, in + k);
            step_.synthesise(in, fine);
            std::copy_n(fine, 2 * k, &out[2 * i * k]);
        }
        std::fill(line.begin(), line.end(), 0.0);
        std::copy_n(out.begin(), 2 * level * k, line.begin());
    }
    return std::sqrt(std::inner_product(line.begin(), line.end(), line.begin(), 0.0));
}

/// All functions of one kind and level have the same norm. Those of coarse functions are stored at the indices of the
/// details of their level.
void KernelTerms::measure_norms() {
    const std::size_t k = step_.order();
    for (std::size_t a = 0; a < k; ++a) {
        detail_norm_[a] = norm_of_function(1, a);
        for (std::size_t n = 1; n < intervals_; n *= 2) {
            const double detail = norm_of_function(n, k + a), coarse = norm_of_function(n, a);
            for (std::size_t i = n; i < 2 * n; ++i) detail_norm_[i * k + a] = detail, coarse_norm_[i * k + a] = coarse;
        }
    }
}

/// Coarse coefficients of a line come first, then the details of finer and finer levels: those of n intervals at [n k,
/// 2 n k).
void KernelTerms::step_rows(std::vector<double>& a, std::size_t intervals, std::size_t rows, bool back) const {
    const std::size_t k = step_.order(), half = intervals / 2;
    std::vector<double> line(intervals * k);
    double in[6], out[6];
    for (std::size_t r = 0; r < rows; ++r) {
        double* row = &a[r * side_];
        for (std::size_t i = 0; i < half; ++i) {
            if (back) {
                std::copy_n(row + i * k, k, in);
                std::copy_n(row + (half + i) * k, k, in + k);
                step_.synthesise(in, out);
                std::copy_n(out, 2 * k, &line[2 * i * k]);
            } else {
                step_.analyse(row + 2 * i * k, out);
                std::copy_n(out, k, &line[i * k]);
                std::copy_n(out + k, k, &line[(half + i) * k]);
            }
        }
        std::copy(line.begin(), line.end(), row);
    }
}

void KernelTerms::step_columns(std::vector<double>& a, std::size_t intervals, std::size_t columns, bool back) const {
    const std::size_t k = step_.order(), half = intervals / 2, count = intervals * k;
    std::vector<double> line(count);
    double in[6], out[6];
    for (std::size_t c = 0; c < columns; ++c) {
        for (std::size_t i = 0; i < half; ++i) {
            for (std::size_t t = 0; t < 2 * k; ++t) {
                const std::size_t row = !back ? 2 * i * k + t : t < k ? i * k + t : (half + i) * k + t - k;
                in[t] = a[row * side_ + c];
            }
            back ? step_.synthesise(in, out) : step_.analyse(in, out);
            for (std::size_t t = 0; t < 2 * k; ++t) {
                const std::size_t row = back ? 2 * i * k + t : t < k ? i * k + t : (half + i) * k + t - k;
                line[row] = out[t];
            }
        }
        for (std::size_t r = 0; r < count; ++r) a[r * side_ + c] = line[r];
    }
}

std::vector<double> KernelTerms::decompose(std::vector<double> a) const {
    if (way_ == Decomposition::standard) {
        for (std::size_t n = intervals_; n > 1; n /= 2) step_rows(a, n, side_, false);
        for (std::size_t n = intervals_; n > 1; n /= 2) step_columns(a, n, side_, false);
        return a;
    }
    for (std::size_t n = intervals_; n > 1; n /= 2) {
        step_rows(a, n, n * step_.order(), false);
        step_columns(a, n, n * step_.order(), false);
    }
    return a;
}

std::vector<double> KernelTerms::reconstruct(std::vector<double> a) const {
    if (way_ == Decomposition::standard) {
        for (std::size_t n = 2; n <= intervals_; n *= 2) step_columns(a, n, side_, true);
        for (std::size_t n = 2; n <= intervals_; n *= 2) step_rows(a, n, side_, true);
        return a;
    }
    for (std::size_t n = 2; n <= intervals_; n *= 2) {
        step_columns(a, n, n * step_.order(), true);
        step_rows(a, n, n * step_.order(), true);
    }
    return a;
}

double KernelTerms::norm_of_term(std::size_t row, std::size_t column) const {
    if (step_.is_orthonormal()) return 1;
    if (way_ == Decomposition::standard) return detail_norm_[row] * detail_norm_[column];
    // The smaller of the two indices belongs to a coarse function of the other's level.
    const std::size_t k = step_.order(), level = std::bit_floor(std::max(row, column) / k);
    if (level == 0) return detail_norm_[row] * detail_norm_[column];
    const auto norm = [&](std::size_t i) { return i / k >= level ? detail_norm_[i] : coarse_norm_[level * k + i % k]; };
    return norm(row) * norm(column);
}

std::vector<double> KernelTerms::errors(std::span<const std::size_t> m) const {
    std::vector<double> weight(size());
    for (std::size_t i = 0; i < size(); ++i) weight[i] = std::abs(terms_[i]) * norm_of_term(i / side_, i % side_);
    std::vector<std::uint32_t> order(size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return weight[a] > weight[b]; });
    const double all = std::inner_product(finest_.begin(), finest_.end(), finest_.begin(), 0.0);
    std::vector<double> out;
    for (const std::size_t count : m) {
        std::vector<double> kept(size());
        for (std::size_t i = 0; i < std::min(count, size()); ++i) kept[order[i]] = terms_[order[i]];
        const std::vector<double> back = reconstruct(std::move(kept));
        double sum = 0;
        for (std::size_t i = 0; i < size(); ++i) sum += (back[i] - finest_[i]) * (back[i] - finest_[i]);
        out.push_back(all > 0 ? std::sqrt(sum / all) : 0);
    }
    return out;
}

}  // namespace exitance::flatland
