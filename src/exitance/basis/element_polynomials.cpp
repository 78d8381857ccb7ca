#include "exitance/basis/element_polynomials.hpp"
#include "exitance/base/limits.hpp"

namespace exitance {

ElementPolynomials::ElementPolynomials(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                                       bool curved)
    : square_(!tree.is_cell(e) && !tree.patch(e).is_triangle()),
      straight_(square_ ? 4 : 3),
      size_(curved ? (square_ ? 9 : 6) : straight_),
      middle_(tree.centre(e)) {
    Vec2 reach{min_divisor, min_divisor};
    for (const Vec2& corner : tree.domain(e))
        reach = {std::max(reach.x, std::abs(corner.x - middle_.x)), std::max(reach.y, std::abs(corner.y - middle_.y))};
    scale_ = {1 / reach.x, 1 / reach.y};

    // Modified Gram-Schmidt: `value` holds the polynomials at the points, `row_` their coefficients.
    std::vector<Values> value;
    for (const WeightedPlace& p : places) value.push_back(monomials(p.uv));
    const auto product = [&](std::size_t j, std::size_t k) {
        double sum = 0;
        for (std::size_t i = 0; i < places.size(); ++i) sum += places[i].weight * value[i][j] * value[i][k];
        return sum;
    };
    for (std::size_t k = 0; k < size_; ++k) {
        row_[k][k] = 1;
        const double before = product(k, k);
        for (int again = 0; again < 2; ++again)  // the second pass removes the rounding error of the first
            for (std::size_t j = 0; j < k; ++j) {
                const double c = product(j, k);
                for (std::size_t i = 0; i < places.size(); ++i) value[i][k] -= c * value[i][j];
                for (std::size_t m = 0; m < k; ++m) row_[k][m] -= c * row_[j][m];
            }
        // Omit a polynomial that is linearly dependent on the previous ones at these points.
        const double rest = product(k, k), factor = rest > 1e-12 * before ? 1 / std::sqrt(rest) : 0;
        for (std::size_t i = 0; i < places.size(); ++i) value[i][k] *= factor;
        for (std::size_t m = 0; m <= k; ++m) row_[k][m] *= factor;
    }
}

ElementPolynomials::Values ElementPolynomials::monomials(Vec2 uv) const {
    const double s = scale_.x * (uv.x - middle_.x), t = scale_.y * (uv.y - middle_.y);
    if (square_) return {1, s, t, s * t, s * s, t * t, s * s * t, s * t * t, s * s * t * t};
    return {1, s, t, s * s, s * t, t * t};
}

ElementPolynomials::Values ElementPolynomials::at(Vec2 uv) const {
    const Values monomial = monomials(uv);
    Values out{};
    for (std::size_t k = 0; k < size_; ++k)
        for (std::size_t j = 0; j <= k; ++j) out[k] += row_[k][j] * monomial[j];
    return out;
}

}  // namespace exitance
