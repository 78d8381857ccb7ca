#include "exitance/io/scenes/textures/colour_grid.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "exitance/io/scenes/textures/texture_cuts.hpp"

namespace exitance {
namespace {

TEST(CoveredAreas, AreExactForPolygonsOfEitherOrientation) {
    const std::vector<double> columns = {0, 0.5, 0.7, 2}, rows = {0, 1, 1.5, 3};
    // A triangle with its right angle at the origin, and the rest of its square, clockwise.
    const std::vector<std::vector<Vec2>> polygons = {{{0, 0}, {2, 0}, {0, 3}}, {{2, 3}, {2, 0}, {0, 3}}};
    const std::vector<double> both = covered_areas(polygons, columns, rows);
    const std::vector<double> lower = covered_areas(std::span(polygons).first(1), columns, rows);
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(both[3 * j + i], (columns[i + 1] - columns[i]) * (rows[j + 1] - rows[j]), 1e-14);
    EXPECT_NEAR(std::accumulate(lower.begin(), lower.end(), 0.0), 3, 1e-14);
    EXPECT_EQ(lower[0], 0.5);
    EXPECT_NEAR(lower[8], 0.5 * 0.3 * 0.45, 1e-14);
    // The hypotenuse y = 3 - 1.5 x is above the cell [0, 0.5] x [1.5, 3] where x < 0: it covers 0.5 (1.5 - 0.75 / 2).
    EXPECT_NEAR(lower[6], 0.5 * (1.5 - 0.375), 1e-14);
}

/// A grid of n x n cells of a square metre with reflectances by column and row.
template <class Reflectance>
ColourGrid grid(std::size_t n, Reflectance&& reflectance) {
    std::vector<double> borders;
    for (std::size_t i = 0; i <= n; ++i) borders.push_back(static_cast<double>(i) / static_cast<double>(n));
    std::vector<ColourGrid::Cell> cells;
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i)
            cells.push_back({1 / static_cast<double>(n * n), Spectrum(reflectance(i, j)), Spectrum()});
    return {borders, borders, cells, false};
}

TEST(ColourGrid, HasMeansDeviationsAndRangesOfBoxes) {
    const ColourGrid g = grid(8, [](std::size_t i, std::size_t j) { return i < 4 ? 0.2 : j < 4 ? 0.4 : 0.8; });
    EXPECT_NEAR(g.mean(g.whole()).reflectance[0], 0.4, 1e-14);
    EXPECT_NEAR(g.mean({4, 8, 0, 8}).area, 0.5, 1e-14);
    const PartColour right = g.colour({4, 8, 0, 8});
    EXPECT_NEAR(right.reflectance.mean[0], 0.6, 1e-14);
    EXPECT_NEAR(right.reflectance.deviation[0], 0.2, 1e-14);
    EXPECT_NEAR(right.reflectance.lowest[0], 0.4, 1e-14);
    EXPECT_NEAR(right.reflectance.highest[0], 0.8, 1e-14);
    EXPECT_EQ(g.colour({0, 4, 0, 8}).reflectance.deviation[0], 0) << "even colours deviate by nothing";
}

/// Squared deviation times area that remains in a patch of a square metre after the given number of cuts.
double left_after(const TextureCuts& cuts, std::size_t count, double mean_square) {
    std::vector<bool> is_cut(cuts.parts.size());
    for (std::size_t c = 0; c < count; ++c) is_cut[cuts.cuts[c].part] = true;
    const std::function<double(std::size_t, double)> squares_of_means = [&](std::size_t p, double area) {
        const double mean = cuts.parts[p].colour.reflectance.mean[0];
        if (!is_cut[p]) return area * mean * mean;
        const std::size_t child = cuts.parts[p].children;
        const double below = cuts.parts[child].colour.reflectance.mean[0];
        const double above = cuts.parts[child + 1].colour.reflectance.mean[0];
        // the area-weighted mean of the two children is the mean of their parent
        const double share = (mean - above) / (below - above);
        return squares_of_means(child, share * area) + squares_of_means(child + 1, (1 - share) * area);
    };
    return mean_square - squares_of_means(0, 1);
}

TEST(TextureCuts, TheErrorOfAGradientFallsAsTheNumberOfParts) {
    const auto value = [](std::size_t i, std::size_t) { return (static_cast<double>(i) + 0.5) / 256; };
    const ColourGrid g = grid(256, value);
    double mean_square = 0;
    for (std::size_t i = 0; i < 256; ++i) mean_square += value(i, 0) * value(i, 0) / 256;
    const TextureCuts cuts = cut_texture(g, {.length = 1, .reflected = 1, .flux = 1, .min_benefit = 0}, 63, 1, 1);
    ASSERT_EQ(cuts.cuts.size(), 63u);
    for (std::size_t parts : {2, 4, 8, 16, 32, 64})  // parts have equal widths if their number is a power of two
        EXPECT_NEAR(left_after(cuts, parts - 1, mean_square), 1.0 / 12 / static_cast<double>(parts * parts), 2e-5)
            << parts;
    for (std::size_t c = 1; c < cuts.cuts.size(); ++c) EXPECT_LE(cuts.cuts[c].benefit, cuts.cuts[c - 1].benefit);
}

TEST(TextureCuts, FollowBordersExactly) {
    const CutScale scale{.length = 1, .reflected = 1, .flux = 1, .min_benefit = 1e-6};
    const ColourGrid two = grid(64, [](std::size_t i, std::size_t) { return i < 23 ? 0.1 : 0.9; });
    const TextureCuts cut = cut_texture(two, scale, 100, 1, 1);
    ASSERT_EQ(cut.cuts.size(), 1u);
    EXPECT_TRUE(cut.parts[0].along_s);
    EXPECT_EQ(cut.parts[0].at, 23.0 / 64);
    // A chequered square of 4 x 4: no single cut has an effect.
    const ColourGrid chess =
        grid(64, [](std::size_t i, std::size_t j) { return (i / 16 + j / 16) % 2 == 0 ? 0.1 : 0.9; });
    const TextureCuts tiles = cut_texture(chess, scale, 100, 1, 1);
    EXPECT_EQ(tiles.cuts.size(), 15u);
    for (const TexturePart& part : tiles.parts) EXPECT_TRUE(part.is_cut || part.colour.reflectance.deviation[0] == 0);
}

TEST(TextureCuts, FineNoiseIsNotCut) {
    const CutScale scale{.length = 2, .reflected = 1, .flux = 1, .min_benefit = 1e-6};
    std::uint32_t state = 1;
    const ColourGrid noise = grid(256, [&](std::size_t, std::size_t) {
        state = state * 1664525u + 1013904223u;
        return 0.4 + 0.2 * static_cast<double>(state >> 16 & 1);
    });
    EXPECT_LT(cut_texture(noise, scale, 1000, 1, 1).cuts.size(), 4u);
}

}  // namespace
}  // namespace exitance
