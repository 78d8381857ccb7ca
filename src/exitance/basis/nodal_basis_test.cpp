#include "exitance/basis/nodal_basis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/quadrature.hpp"
#include "exitance/base/random.hpp"
#include "exitance/basis/two_scale.hpp"

namespace exitance {
namespace {

constexpr HierarchyBasis all_kinds[] = {HierarchyBasis::haar, HierarchyBasis::flatlet2, HierarchyBasis::flatlet3,
                                        HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3};
constexpr double rounding = 1e-13;

template <std::size_t M>
double dot(const TwoScaleRow<M>& a, const TwoScaleRow<M>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < M; ++i) sum += a.left[i] * b.left[i] + a.right[i] * b.right[i];
    return sum;
}

template <std::size_t M>
void expect_orthonormal(const TwoScale<M>& filters) {
    std::vector<TwoScaleRow<M>> rows(filters.smooth.begin(), filters.smooth.end());
    rows.insert(rows.end(), filters.detail.begin(), filters.detail.end());
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = 0; j < rows.size(); ++j) EXPECT_NEAR(dot(rows[i], rows[j]), i == j ? 1 : 0, rounding);
}

TEST(TwoScale, RowsOfMultiwaveletsAreOrthonormal) {
    expect_orthonormal(two_scale::haar);
    expect_orthonormal(two_scale::multiwavelet2);
    expect_orthonormal(two_scale::multiwavelet3);
}

/// Orthonormal Legendre polynomials on [0, 1].
double legendre(std::size_t i, double t) {
    const double x = 2 * t - 1;
    return i == 0 ? 1 : i == 1 ? std::sqrt(3.0) * x : std::sqrt(5.0) * 0.5 * (3 * x * x - 1);
}

/// Returns Int_0^1 t^power f(t) for the function f of a row; exact (Gauss rule of 8 points on each half).
template <std::size_t M>
double moment(const TwoScaleRow<M>& row, int power) {
    double sum = 0;
    for (const PlanarNode& node : square_rule(8)) {
        const double t = node.at.x;
        double left = 0, right = 0;
        for (std::size_t i = 0; i < M; ++i) {
            left += row.left[i] * std::sqrt(2.0) * legendre(i, t);
            right += row.right[i] * std::sqrt(2.0) * legendre(i, t);
        }
        sum += node.weight * 0.5 * (left * std::pow(0.5 * t, power) + right * std::pow(0.5 + 0.5 * t, power));
    }
    return sum;
}

template <std::size_t M>
void expect_vanishing_moments(const TwoScale<M>& filters) {
    for (std::size_t k = 0; k < M; ++k) {
        const int vanishing = static_cast<int>(M + k);
        for (int p = 0; p < vanishing; ++p) EXPECT_NEAR(moment(filters.detail[k], p), 0, rounding) << k << " " << p;
        EXPECT_GT(std::abs(moment(filters.detail[k], vanishing)), 1e-4);
    }
}

TEST(TwoScale, DetailsOfMultiwaveletsHaveAsManyVanishingMomentsAsTheyClaim) {
    expect_vanishing_moments(two_scale::haar);
    expect_vanishing_moments(two_scale::multiwavelet2);
    expect_vanishing_moments(two_scale::multiwavelet3);
}

TEST(TwoScale, DetailsOfFlatletsVanishOnPolynomials) {
    const auto cells = [](const auto& row, std::size_t M, int power) {
        double sum = 0;
        for (std::size_t i = 0; i < 2 * M; ++i) {
            const double lo = static_cast<double>(i),
                         mean = (std::pow(lo + 1, power + 1) - std::pow(lo, power + 1)) / (power + 1);
            sum += (i < M ? row.left[i] : row.right[i - M]) * mean;
        }
        return sum;
    };
    for (int p = 0; p < 2; ++p)
        for (const auto& row : two_scale::flatlet2.detail) EXPECT_NEAR(cells(row, 2, p), 0, 1e-12);
    for (int p = 0; p < 3; ++p)
        for (const auto& row : two_scale::flatlet3.detail) EXPECT_NEAR(cells(row, 3, p), 0, 1e-11);
}

TEST(TwoScale, FlatletSynthesisReproducesALinearAndAQuadraticFunction) {
    const auto& two = two_scale::flatlet2_synthesis;
    for (std::size_t cell = 0; cell < 4; ++cell)  // the cells have means 1, 2, 3, 4 and the boxes 1.5 and 3.5
        EXPECT_NEAR(two[cell][0] * 1.5 + two[cell][1] * 3.5, static_cast<double>(cell + 1), rounding);
    const auto& three = two_scale::flatlet3_synthesis;
    const auto cell_mean = [](double i) { return (std::pow(i + 1, 3) - std::pow(i, 3)) / 3; };
    for (std::size_t cell = 0; cell < 6; ++cell) {
        double sum = 0;
        for (std::size_t box = 0; box < 3; ++box)
            sum += three[cell][box] * 0.5 *
                   (cell_mean(2.0 * static_cast<double>(box)) + cell_mean(2.0 * static_cast<double>(box) + 1));
        EXPECT_NEAR(sum, cell_mean(static_cast<double>(cell)), 1e-12);
    }
}

/// A square split into four: the push matrix is the tensor product of the one-dimensional synthesis.
TEST(NodalBasis, PushOfFlatletsIsTheTensorProductOfTheSynthesis) {
    const NodalBasis two(HierarchyBasis::flatlet2), three(HierarchyBasis::flatlet3);
    for (std::size_t child = 0; child < 4; ++child) {
        const auto p2 = two.push(Patch::Shape::parallelogram, Cut::both, child);
        const auto p3 = three.push(Patch::Shape::parallelogram, Cut::both, child);
        const std::size_t cu = child & 1, cv = child >> 1;
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t j = 0; j < 4; ++j)
                EXPECT_NEAR(p2[k * 4 + j],
                            two_scale::flatlet2_synthesis[2 * cu + k % 2][j % 2] *
                                two_scale::flatlet2_synthesis[2 * cv + k / 2][j / 2],
                            rounding);
        for (std::size_t k = 0; k < 9; ++k)
            for (std::size_t j = 0; j < 9; ++j)
                EXPECT_NEAR(p3[k * 9 + j],
                            two_scale::flatlet3_synthesis[3 * cu + k % 3][j % 3] *
                                two_scale::flatlet3_synthesis[3 * cv + k / 3][j / 3],
                            rounding);
    }
}

/// Converts values at the Gauss nodes of an interval to coefficients of the orthonormal polynomials.
template <std::size_t M>
std::array<double, M> to_modes(const std::array<double, M>& nodal) {
    const LineRule rule = gauss_legendre(static_cast<int>(M));
    std::array<double, M> out{};
    for (std::size_t i = 0; i < M; ++i)
        for (std::size_t k = 0; k < M; ++k) out[i] += rule.weights[k] * legendre(i, rule.nodes[k]) * nodal[k];
    return out;
}

template <std::size_t M>
void expect_push_agrees(HierarchyBasis kind, const TwoScale<M>& filters) {
    const NodalBasis basis(kind);
    // Functions of u alone: node k of the square has the u of node k % M on the line.
    for (std::size_t unit = 0; unit < M; ++unit) {
        std::array<double, M> parent{};
        parent[unit] = 1;
        const std::array<double, M> coarse = to_modes(parent);
        for (std::size_t child = 0; child < 2; ++child) {
            const auto push = basis.push(Patch::Shape::parallelogram, Cut::u, child);
            std::array<double, M> nodal{};
            for (std::size_t k = 0; k < M; ++k)
                for (std::size_t j = 0; j < M * M; ++j) nodal[k] += push[k * M * M + j] * parent[j % M];
            const std::array<double, M> modes = to_modes(nodal);
            for (std::size_t j = 0; j < M; ++j) {
                double expected =
                    // c_child = sqrt 2 H^T c_parent; the factor sqrt 2 arises because the basis is orthonormal on the
                    // half interval
                    0;
                for (std::size_t i = 0; i < M; ++i)
                    expected += std::sqrt(2.0) * coarse[i] *
                                (child == 0 ? filters.smooth[i].left[j] : filters.smooth[i].right[j]);
                EXPECT_NEAR(modes[j], expected, rounding);
            }
        }
    }
}

TEST(NodalBasis, PushAgreesWithTheTwoScaleFilters) {
    expect_push_agrees(HierarchyBasis::haar, two_scale::haar);
    expect_push_agrees(HierarchyBasis::multiwavelet2, two_scale::multiwavelet2);
    expect_push_agrees(HierarchyBasis::multiwavelet3, two_scale::multiwavelet3);
}

std::vector<double> random_numbers(std::size_t count, std::uint64_t seed) {
    RandomStream random(seed, Stream::mesh);
    std::vector<double> out(count);
    for (double& v : out) v = random.uniform();
    return out;
}

TEST(NodalBasis, PullAfterPushChangesNothing) {
    for (const HierarchyBasis kind : all_kinds) {
        const NodalBasis basis(kind);
        for (const auto& [shape, way] : {std::pair{Patch::Shape::parallelogram, Cut::u},
                                         {Patch::Shape::parallelogram, Cut::v},
                                         {Patch::Shape::parallelogram, Cut::both},
                                         {Patch::Shape::triangle, Cut::both}}) {
            const std::size_t n = basis.count(), children = way == Cut::both ? 4 : 2;
            // The parent's function must be a polynomial of the basis; on triangles, not all coefficients of flatlets
            // are.
            std::vector<double> any = random_numbers(n, 7), parent(n), back(n, 0.0);
            if (shape == Patch::Shape::triangle && basis.is_flat()) {
                // The mean of a linear function over a triangle is its value at the centroid.
                std::vector<double> factors(n);
                for (std::size_t k = 0; k < n; ++k) {
                    const Vec2 at = basis.nodes(shape)[k].at;
                    parent[k] = basis.order() == 1 ? 2 : 1 + 2 * at.x - 3 * at.y;
                }
            } else {
                parent = any;
            }
            for (std::size_t c = 0; c < children; ++c) {
                const auto push = basis.push(shape, way, c), pull = basis.pull(shape, way, c);
                for (std::size_t k = 0; k < n; ++k) {
                    double child = 0;
                    for (std::size_t j = 0; j < n; ++j) child += push[k * n + j] * parent[j];
                    for (std::size_t i = 0; i < n; ++i) back[i] += pull[i * n + k] * child;
                }
            }
            for (std::size_t i = 0; i < n; ++i) {
                if (basis.nodes(shape)[i].weight == 0) continue;
                EXPECT_NEAR(back[i], parent[i], rounding) << static_cast<int>(kind);
            }
        }
    }
}

TEST(NodalBasis, PolynomialsOfItsDegreeAreInterpolatedExactly) {
    for (const HierarchyBasis kind : all_kinds) {
        const NodalBasis basis(kind);
        // The mean of a quadratic over a box is not its value at the centre.
        if (basis.is_flat() && basis.order() == 3) continue;
        for (const Patch::Shape shape : {Patch::Shape::parallelogram, Patch::Shape::triangle}) {
            const auto f = [&](Vec2 p) {
                const double s = basis.order() > 1 ? 3 * p.x - 2 * p.y : 0;
                return 1 + s + (basis.order() > 2 ? 0.5 * p.x * p.y - p.x * p.x : 0);
            };
            std::vector<double> factors(basis.count());
            for (const Vec2 at : {Vec2{0.2, 0.3}, Vec2{0.7, 0.1}, Vec2{0, 0}}) {
                basis.interpolate(shape, at, factors);
                double value = 0;
                for (std::size_t k = 0; k < basis.count(); ++k) value += factors[k] * f(basis.nodes(shape)[k].at);
                EXPECT_NEAR(value, f(at), 1e-12) << static_cast<int>(kind);
            }
        }
    }
}

TEST(NodalBasis, EveryBoxContainsItsOwnCentre) {
    for (const HierarchyBasis kind : {HierarchyBasis::haar, HierarchyBasis::flatlet2, HierarchyBasis::flatlet3}) {
        const NodalBasis basis(kind);
        for (const Patch::Shape shape : {Patch::Shape::parallelogram, Patch::Shape::triangle})
            for (std::size_t k = 0; k < basis.count(); ++k) EXPECT_EQ(basis.box_at(shape, basis.nodes(shape)[k].at), k);
    }
}

}  // namespace
}  // namespace exitance
