#include "exitance/mesh/discontinuity/clough_tocher.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

using Function = std::function<double(Vec2)>;
using Gradient = std::function<Vec2(Vec2)>;
using Corners = std::array<Vec2, 3>;

CloughTocher::Data data_of(const Corners& corner, const Function& f, const Gradient& slope) {
    CloughTocher::Data data{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 j = corner[(i + 1) % 3], k = corner[(i + 2) % 3], middle = 0.5 * (corner[i] + j);
        data.value[i] = f(corner[i]);
        data.to_next[i] = {dot(slope(corner[i]), j - corner[i]), dot(slope(corner[i]), k - corner[i])};
        data.across[i] = dot(slope(middle), k - middle);
    }
    return data;
}

Vec2 place(const Corners& corner, const std::array<double, 3>& L) {
    return L[0] * corner[0] + L[1] * corner[1] + L[2] * corner[2];
}

std::array<double, 3> random_place(RandomStream& random) {
    const double a = random.uniform(), b = random.uniform() * (1 - a);
    return {a, b, 1 - a - b};
}

TEST(CloughTocher, ReproducesCubicPolynomials) {
    const Function f = [](Vec2 p) {
        return 1 + 2 * p.x - p.y + p.x * p.x * p.y - 3 * p.y * p.y * p.y + 0.5 * p.x * p.y;
    };
    const Gradient slope = [](Vec2 p) {
        return Vec2{2 + 2 * p.x * p.y + 0.5 * p.y, -1 + p.x * p.x - 9 * p.y * p.y + 0.5 * p.x};
    };
    const Corners corner{{{0.2, -0.1}, {1.3, 0.4}, {-0.3, 0.9}}};
    const CloughTocher element(data_of(corner, f, slope));
    RandomStream random(1, Stream::mesh);
    constexpr double rounding = 1e-13;
    for (int i = 0; i < 100; ++i) {
        const auto L = random_place(random);
        EXPECT_NEAR(element.at(L), f(place(corner, L)), rounding);
    }
    // Radon's rule with seven points has degree five; the mean of a cubic is that of four values: corners, middles,
    // centroid.
    double sum = 9.0 / 20 * f(place(corner, {1.0 / 3, 1.0 / 3, 1.0 / 3}));
    for (std::size_t k = 0; k < 3; ++k)
        sum += f(corner[k]) / 20 + 2.0 / 15 * f(0.5 * (corner[k] + corner[(k + 1) % 3]));
    EXPECT_NEAR(element.mean(), sum, rounding);
}

TEST(CloughTocher, ItsThreePartsJoinWithOneTangentPlane) {
    RandomStream random(2, Stream::mesh);
    CloughTocher::Data data{};
    for (std::size_t i = 0; i < 3; ++i) {
        data.value[i] = random.uniform(), data.across[i] = random.uniform();
        data.to_next[i] = {random.uniform(), random.uniform()};
    }
    const CloughTocher element(data);
    // Four values on one side of a point give a cubic's slope there exactly, up to rounding divided by the step.
    constexpr double step = 1e-2, rounding = 1e-11;
    const auto slope = [&](const std::array<double, 3>& L, const std::array<double, 3>& d) {
        const auto at = [&](double k) {
            return element.at({L[0] + k * step * d[0], L[1] + k * step * d[1], L[2] + k * step * d[2]});
        };
        return (-11 * at(0) + 18 * at(1) - 9 * at(2) + 2 * at(3)) / (6 * step);
    };
    for (std::size_t i = 0; i < 3; ++i)
        for (const double t : {0.2, 0.5, 0.8}) {
            // On the line from corner i to the centroid; the step from corner i + 1 to i + 2 crosses it.
            std::array<double, 3> L{}, d{}, back{};
            for (std::size_t k = 0; k < 3; ++k) L[k] = (1 - t) / 3;
            L[i] += t;
            d[(i + 1) % 3] = back[(i + 2) % 3] = -1, d[(i + 2) % 3] = back[(i + 1) % 3] = 1;
            EXPECT_NEAR(slope(L, d), -slope(L, back), rounding);
        }
    for (const std::array<double, 3>& d : {std::array{1.0, -1.0, 0.0}, {0.0, 1.0, -1.0}, {1.0, 1.0, -2.0}}) {
        const std::array<double, 3> middle{1.0 / 3, 1.0 / 3, 1.0 / 3}, back{-d[0], -d[1], -d[2]};
        EXPECT_NEAR(slope(middle, d), -slope(middle, back), rounding);
    }
}

}  // namespace
}  // namespace exitance
