#include "exitance/view_factors/factor_operator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/samples/generate.hpp"
#include "exitance/view_factors/gray_exchange.hpp"
#include "exitance/view_factors/row_check.hpp"
#include "exitance/view_factors/row_factors.hpp"

namespace exitance {
namespace {

Scene complex_of(const char* m) {
    return *make_scene(*generate_scene("complex", {{"m", m}})).scene;
}

/// Houses of random heights on a square, below an open sky: 6 x 6 x 5 + 36 faces.
Scene small_town() {
    SceneDescription d;
    d.materials.push_back({"grey", Spectrum(0.25), Spectrum()});
    d.groups.push_back("town");
    const auto add = [&](std::initializer_list<Point> corners) {
        SceneDescription::Face face;
        for (const Point& p : corners)
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size())), d.points.push_back(p);
        d.faces.push_back(face);
    };
    RandomStream random(1, Stream::reference);
    for (int a = 0; a < 6; ++a)
        for (int b = 0; b < 6; ++b) {
            const double x = 20 * a, y = 20 * b, X = x + 12, Y = y + 12, h = 5 + 20 * random.uniform();
            add({{x, y, h}, {X, y, h}, {X, Y, h}, {x, Y, h}});
            add({{x, y, 0}, {X, y, 0}, {X, y, h}, {x, y, h}});
            add({{X, Y, 0}, {x, Y, 0}, {x, Y, h}, {X, Y, h}});
            add({{X, y, 0}, {X, Y, 0}, {X, Y, h}, {X, y, h}});
            add({{x, Y, 0}, {x, y, 0}, {x, y, h}, {x, Y, h}});
            add({{x - 4, y - 4, 0}, {X + 4, y - 4, 0}, {X + 4, Y + 4, 0}, {x - 4, Y + 4, 0}});
        }
    return *make_scene(d).scene;
}

SparseFactors table_of(const Scene& scene, const RowFactorOptions& options) {
    Progress progress;
    return compute_row_factors(scene, options, nullptr, progress, StopRequest());
}

FactorOperator operator_of(const Scene& scene, double error) {
    return make_factor_operator(make_view_faces(scene), table_of(scene, operator_table_options(error, 0, 1)),
                                node_share * error);
}

std::vector<double> product(const FactorOperator& F, const std::vector<double>& x) {
    std::vector<double> y(F.size());
    F.apply(x, y);
    return y;
}

std::vector<double> product(const SparseFactors& F, const std::vector<double>& x) {
    std::vector<double> y(F.size());
    for (std::size_t i = 0; i < y.size(); ++i)
        for (std::size_t k = F.starts[i]; k < F.starts[i + 1]; ++k) y[i] += F.values[k] * x[F.columns[k]];
    return y;
}

std::vector<double> random_radiosity(std::size_t count, std::uint64_t seed) {
    RandomStream random(seed, Stream::reference);
    std::vector<double> values(count);
    for (double& value : values) value = 2 * random.uniform() - 1;
    return values;
}

/// x = 1, and indicators of 16 groups of faces that are near to each other.
std::vector<std::vector<double>> groups_of(const Scene& scene) {
    const std::vector<ViewFace> faces = make_view_faces(scene);
    RandomStream random(7, Stream::reference);
    std::vector<std::vector<double>> out(1, std::vector<double>(faces.size(), 1));
    for (int g = 0; g < 16; ++g) {
        const Point centre = faces[std::size_t(random.uniform() * double(faces.size()))].box.centre();
        const double radius = scene.size() * random.uniform();
        std::vector<double>& x = out.emplace_back();
        for (const ViewFace& face : faces) x.push_back(norm(face.box.centre() - centre) < radius);
    }
    return out;
}

TEST(FactorOperator, ProductsMissARowByLessThanTheRequestedError) {
    const double R = 0.03, reference_error = 3e-3;
    for (const Scene& scene : {small_town(), complex_of("12")}) {
        const FactorOperator F = operator_of(scene, R);
        const SparseFactors reference = table_of(scene, {.error = reference_error});
        EXPECT_GT(F.node_entries(), F.size());  // otherwise nothing is tested
        EXPECT_LE(F.closure_defect(), R);
        EXPECT_LE(*std::max_element(F.rows.row_errors.begin(), F.rows.row_errors.end()), R);
        for (const std::vector<double>& x : groups_of(scene)) {
            const std::vector<double> y = product(F, x), exact = product(reference, x);
            for (std::size_t i = 0; i < y.size(); ++i)
                EXPECT_NEAR(y[i], exact[i], R + 3.5 * reference_error) << i;  // noise of the reference
        }
    }
}

/// Entries are merged only if they are small in both rows, so that the reciprocal product A^-1 F^T A x is accurate,
/// too, up to the differences between the members of a node.
TEST(FactorOperator, TransposedProductsAreReciprocal) {
    const double R = 0.03;
    const Scene scene = complex_of("12");
    const FactorOperator F = operator_of(scene, R);
    const SparseFactors reference = table_of(scene, {.error = 3e-3});
    for (const std::vector<double>& x : groups_of(scene)) {
        std::vector<double> power(x.size()), y(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) power[i] = x[i] * F.rows.areas[i];
        F.apply_transposed(power, y);
        const std::vector<double> exact = product(reference, x);
        double squares = 0;
        for (std::size_t j = 0; j < y.size(); ++j) {
            const double off = y[j] / F.rows.areas[j] - exact[j];
            EXPECT_LT(std::abs(off), 3 * R) << j;  // at most 2.3 R was measured, with 5,405 faces and R = 0.01
            squares += off * off;
        }
        EXPECT_LT(std::sqrt(squares / double(y.size())), R);
    }
}

TEST(FactorOperator, RaysConfirmItsRows) {
    const Scene scene = complex_of("12");
    const double R = 0.03;
    const FactorOperator F = operator_of(scene, R);
    const RowCheck check = check_rows_by_rays(
        scene, F.rows.finished, [&](std::size_t i) { return F.dense_row(i); }, {.rows = 40, .rays = 20'000, .error = R},
        StopRequest());
    EXPECT_EQ(check.rows.size(), 40u);
    EXPECT_EQ(check.wrong_sums, 0u);
    // A row without entries must fail.
    const RowCheck of_zeros = check_rows_by_rays(
        scene, F.rows.finished, [&](std::size_t) { return std::vector<double>(F.size()); },
        {.rows = 4, .rays = 20'000, .error = R}, StopRequest());
    EXPECT_EQ(of_zeros.wrong_sums, 4u);
}

TEST(FactorOperator, MergingKeepsRowSumsAndItsErrorBound) {
    const Scene scene = complex_of("12");
    const SparseFactors table = table_of(scene, {.error = 0.02});
    const FactorOperator F = make_factor_operator(make_view_faces(scene), table, 0.02);
    EXPECT_LT(F.rows.entries(), table.entries());
    const std::vector<double> one(F.size(), 1), x = random_radiosity(F.size(), 3);
    const std::vector<double> sums = product(F, one), y = product(F, x), exact = product(table, x);
    for (std::size_t i = 0; i < F.size(); ++i) {
        EXPECT_NEAR(sums[i], table.row_sums[i], 1e-12);  // rounding
        double bound = 0, squares = 0;
        for (std::size_t k = F.rows.starts[i]; k < F.rows.starts[i + 1]; ++k)
            if (F.rows.columns[k] >= F.size()) bound += 2 * F.rows.values[k], squares += std::pow(F.rows.values[k], 2);
        EXPECT_LE(std::abs(y[i] - exact[i]), bound + 1e-12);  // |x| <= 1, so x differs from its mean by at most 2
        EXPECT_LE(std::sqrt(squares), 0.02 * (1 + 1e-12));
        EXPECT_NEAR(F.rows.row_errors[i], std::hypot(table.row_errors[i], std::sqrt(squares)), 1e-12);
    }
}

TEST(FactorOperator, TransposedProductIsTheAdjointAndRowsAreItsMatrix) {
    const FactorOperator F = operator_of(complex_of("6"), 0.05);
    const std::vector<double> x = random_radiosity(F.size(), 1), y = random_radiosity(F.size(), 2);
    const std::vector<double> forward = product(F, x);
    std::vector<double> backward(F.size());
    F.apply_transposed(y, backward);
    EXPECT_NEAR(std::inner_product(y.begin(), y.end(), forward.begin(), 0.0),
                std::inner_product(x.begin(), x.end(), backward.begin(), 0.0), 1e-12);
    for (std::size_t i = 0; i < F.size(); ++i) {
        const std::vector<double> row = F.dense_row(i);
        EXPECT_NEAR(std::inner_product(x.begin(), x.end(), row.begin(), 0.0), forward[i], 1e-13);
    }
}

TEST(FactorOperator, BitsDoNotDependOnThreads) {
    const Scene scene = complex_of("6");
    const int before = threads();
    set_threads(1);
    const FactorOperator one = operator_of(scene, 0.05);
    const std::vector<double> x = random_radiosity(one.size(), 1), y = product(one, x);
    set_threads(4);
    const FactorOperator four = operator_of(scene, 0.05);
    EXPECT_EQ(one.rows.values, four.rows.values);
    EXPECT_EQ(one.rows.columns, four.rows.columns);
    EXPECT_EQ(y, product(four, x));
    set_threads(before);
}

/// A heat balance is as accurate on the operator as on its table, up to the error of the rows times the range of
/// radiosities.
TEST(FactorOperator, HeatBalancesLikeATable) {
    const double R = 0.03;
    const Scene scene = complex_of("12");
    const FactorOperator F = operator_of(scene, R);
    const SparseFactors reference = table_of(scene, {.error = 3e-3});
    std::vector<ThermalSurface> surfaces(F.size(), {0.8, 300.0});
    surfaces[0] = {0.9, 400.0};
    const Result<GrayExchange> found = solve_gray_exchange(F, surfaces, 300.0, StopRequest());
    const Result<GrayExchange> exact = solve_gray_exchange(reference, surfaces, 300.0, StopRequest());
    ASSERT_TRUE(found && exact);
    const double range = stefan_boltzmann * (std::pow(400, 4) - std::pow(300, 4));
    double sum = 0;
    for (std::size_t i = 0; i < F.size(); ++i) {
        EXPECT_NEAR(found->heat[i] / F.rows.areas[i], exact->heat[i] / F.rows.areas[i], R * range) << i;
        sum += found->heat[i];
    }
    EXPECT_NEAR(sum, found->surroundings, 1e-6 * std::abs(found->heat[0]));  // the solver's tolerance
}

}  // namespace
}  // namespace exitance
