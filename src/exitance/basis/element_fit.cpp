#include "exitance/basis/element_fit.hpp"

namespace exitance {
namespace {

std::vector<WeightedPlace> square_rule(RuleOrder order) {
    std::vector<WeightedPlace> rule;
    if (order == RuleOrder::nodes) {
        const double g = 0.5 / std::sqrt(3.0);
        for (const double v : {0.5 - g, 0.5 + g})
            for (const double u : {0.5 - g, 0.5 + g}) rule.push_back({{u, v}, 0.25});
        return rule;
    }
    const double g = 0.5 * std::sqrt(0.6), x[3] = {0.5 - g, 0.5, 0.5 + g}, w[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) rule.push_back({{x[i], x[j]}, w[i] * w[j]});
    return rule;
}

std::vector<WeightedPlace> triangle_rule(RuleOrder order) {
    if (order == RuleOrder::nodes)
        return {{{1.0 / 6, 1.0 / 6}, 1.0 / 3}, {{2.0 / 3, 1.0 / 6}, 1.0 / 3}, {{1.0 / 6, 2.0 / 3}, 1.0 / 3}};
    const double s = std::sqrt(15.0), a = (6 - s) / 21, b = (6 + s) / 21;
    const double wa = (155 - s) / 1200, wb = (155 + s) / 1200;
    return {
        {{1.0 / 3, 1.0 / 3}, 9.0 / 40}, {{a, a}, wa},        {{1 - 2 * a, a}, wa}, {{a, 1 - 2 * a}, wa}, {{b, b}, wb},
        {{1 - 2 * b, b}, wb},           {{b, 1 - 2 * b}, wb}};
}

/// On the way from the centre to each corner, where Gauss's nodes of a parallelogram would stand; or the fan of
/// triangles around the centre, each with the rule of three places.
std::vector<WeightedPlace> cell_rule(const std::vector<Vec2>& domain, Vec2 centre, RuleOrder order) {
    const std::size_t n = domain.size();
    std::vector<WeightedPlace> rule;
    double whole = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 before = domain[(i + n - 1) % n] - centre, a = domain[i] - centre, b = domain[(i + 1) % n] - centre;
        const double area = 0.5 * cross(a, b);
        whole += area;
        if (order == RuleOrder::nodes) {
            const double reach = n == 3 ? 0.5 : 1 / std::sqrt(3.0);
            rule.push_back({centre + reach * a, 0.5 * (area + 0.5 * cross(before, a))});
        } else {
            for (const auto& [p, q] : {std::pair{1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6}, {1.0 / 6, 2.0 / 3}})
                rule.push_back({centre + p * a + q * b, area / 3});
        }
    }
    for (WeightedPlace& place : rule) place.weight /= whole;
    return rule;
}

/// Solves the symmetric positive system M x = y of `n` unknowns for every band; M is overwritten (Cholesky).
void solve_small(std::array<std::array<double, 4>, 4>& M, std::array<Spectrum, 4>& y, std::size_t n) {
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t j = 0; j < k; ++j) {
            for (std::size_t i = k; i < n; ++i) M[i][k] -= M[i][j] * M[k][j];
        }
        // A direction in which the places do not spread is left out: the polynomial is level along it.
        const double pivot = M[k][k] > 1e-12 ? std::sqrt(M[k][k]) : HUGE_VAL;
        for (std::size_t i = k; i < n; ++i) M[i][k] /= pivot;
        if (pivot == HUGE_VAL) M[k][k] = HUGE_VAL;
    }
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t j = 0; j < k; ++j) y[k] -= M[k][j] * y[j];
        y[k] *= 1 / M[k][k];
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t i = k + 1; i < n; ++i) y[k] -= M[i][k] * y[i];
        y[k] *= 1 / M[k][k];
    }
}

}  // namespace

std::vector<WeightedPlace> element_rule(const ElementTree& tree, ElementId e, RuleOrder order) {
    if (tree.is_cell(e)) return cell_rule(tree.domain(e), tree.centre(e), order);
    return tree.patch(e).is_triangle() ? triangle_rule(order) : square_rule(order);
}

ElementFit::ElementFit(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                       std::span<const Spectrum> values)
    : freedoms_(tree.is_cell(e) || tree.patch(e).is_triangle() ? 3 : 4), middle_(tree.centre(e)) {
    const Patch& patch = tree.patch(e);
    for (int i = 0; i < patch.corner_count(); ++i) corner_uv_[static_cast<std::size_t>(i)] = patch.corner_uv(i);
    std::array<std::array<double, 4>, 4> M{};
    for (std::size_t p = 0; p < places.size(); ++p) {
        const std::array<double, 4> phi = basis_at(places[p].uv);
        for (std::size_t i = 0; i < freedoms_; ++i) {
            coefficient_[i] += (places[p].weight * phi[i]) * values[p];
            for (std::size_t j = 0; j <= i; ++j) M[i][j] += places[p].weight * phi[i] * phi[j];
        }
    }
    solve_small(M, coefficient_, freedoms_);
}

std::array<double, 4> ElementFit::basis_at(Vec2 uv) const {
    const double s = uv.x - middle_.x, t = uv.y - middle_.y;
    return {1, s, t, s * t};
}

Spectrum ElementFit::at(Vec2 uv) const {
    const std::array<double, 4> phi = basis_at(uv);
    Spectrum sum;
    for (std::size_t i = 0; i < freedoms_; ++i) sum += phi[i] * coefficient_[i];
    return sum;
}

}  // namespace exitance
