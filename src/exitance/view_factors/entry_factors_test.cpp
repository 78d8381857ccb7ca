#include "exitance/view_factors/entry_factors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "exitance/base/parallel.hpp"
#include "exitance/form_factors/pair_form_factor.hpp"
#include "support/dense_view_factors.hpp"
#include "support/outline_scene.hpp"
#include "support/places.hpp"

namespace exitance {
namespace {

ViewFactors factors_of(const Scene& scene, double tolerance) {
    return dense_view_factors(scene, tolerance);
}

/// Adds the six faces of a box, each split into k x k pieces, with fronts inwards or outwards.
void add_box(std::vector<Outline>& faces, const Point& lo, const Point& hi, bool inwards, int k) {
    const Vec3 size = hi - lo;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (bool upper : {false, true})
            for (int a = 0; a < k; ++a)
                for (int b = 0; b < k; ++b) {
                    const auto at = [&](int s, int t) {
                        Point p = lo;
                        p[axis] = upper ? hi[axis] : lo[axis];
                        p[(axis + 1) % 3] += size[(axis + 1) % 3] * s / k;
                        p[(axis + 2) % 3] += size[(axis + 2) % 3] * t / k;
                        return p;
                    };
                    Outline face = {at(a, b), at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)};
                    if (upper == inwards) std::reverse(face.begin(), face.end());
                    faces.push_back(face);
                }
}

Scene room_with_blocks() {
    std::vector<Outline> faces;
    add_box(faces, {0, 0, 0}, {4, 3, 2.5}, true, 3);
    add_box(faces, {0.7, 0.6, 0.2}, {1.5, 1.4, 1.1}, false, 2);
    add_box(faces, {2.3, 1.1, 0.1}, {3.2, 2.2, 1.4}, false, 1);
    return scene_of(faces);
}

TEST(EntryFactors, RowsOfABoxSumToOneAndAreReciprocal) {
    std::vector<Outline> faces;
    add_box(faces, {0, 0, 0}, {5, 4, 3}, true, 2);
    const ViewFactors table = factors_of(scene_of(faces), 1e-9);
    for (double sum : table.row_sums) EXPECT_NEAR(sum, 1, 1e-8);  // entries have a tolerance of 1e-9
    EXPECT_LT(table.reciprocity_defect, 1e-8);
    EXPECT_EQ(table.emittances[0], 0.75);
}

TEST(EntryFactors, RowsOfARoomWithBlocksSumToOneWithoutNormalization) {
    const Scene scene = room_with_blocks();
    const ViewFactors coarse = factors_of(scene, 1e-4), fine = factors_of(scene, 1e-6);
    for (double sum : coarse.row_sums) EXPECT_NEAR(sum, 1, 1e-4);
    for (double sum : fine.row_sums) EXPECT_NEAR(sum, 1, 2e-6);  // entries have a tolerance of 1e-6
    EXPECT_LT(coarse.reciprocity_defect, 1e-4);
    EXPECT_LT(fine.reciprocity_defect, 2e-6);
}

TEST(EntryFactors, RowsOfAClutteredRoomSumToOneAndAreReciprocal) {
    // Ten blocks, one on the floor; walls see each other between them.
    std::vector<Outline> faces;
    add_box(faces, {0, 0, 0}, {2, 2, 1}, true, 1);
    for (int i = 0; i < 9; ++i) {
        const Point lo{0.2 + 0.6 * (i % 3), 0.22 + 0.58 * (i / 3), 0.2 + 0.06 * i};
        add_box(faces, lo, lo + Vec3{0.2, 0.24, 0.1}, false, 1);
    }
    add_box(faces, {0.5, 0.5, 0}, {0.6, 0.62, 0.5}, false, 1);
    const double tolerance = 4e-3;
    const ViewFactors table = factors_of(scene_of(faces), tolerance);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const bool covered = std::abs(table.row_sums[i]) < 1e-12;  // the bottom of the block on the floor
        const double stands = i == 4 ? 0.1 * 0.12 / 4 : 0;         // share of the floor that the block covers
        // Errors of several entries add up.
        EXPECT_NEAR(table.row_sums[i], covered ? 0 : 1 - stands, 2 * tolerance) << i;
    }
    EXPECT_LT(table.reciprocity_defect, 2 * tolerance);  // tolerance: both rows have errors
}

/// The room of the complex family with the seat of one chair on one leg. The bounding boxes of the slanting walls
/// contain the whole room. The seat's edge passes over the leg's sides at a fortieth of their height.
Scene room_with_a_stool() {
    const auto prism = [](const Outline& low, const Outline& high, std::vector<Outline>& faces) {
        for (std::size_t k = 0; k < low.size(); ++k) {
            const std::size_t next = (k + 1) % low.size();
            faces.push_back({low[k], low[next], high[next], high[k]});
        }
    };
    const auto lifted = [](Outline outline, double z) {
        for (Point& p : outline) p.z = z;
        return outline;
    };
    const auto turned = [](Outline outline) { return Outline(outline.rbegin(), outline.rend()); };
    const Outline floor = {
        {0, 5.87877538268, 0}, {-5.09116882454, -2.93938769134, 0}, {5.09116882454, -2.93938769134, 0}};
    const Outline ceiling = {{0, 1.71464281995, 5.87877538268},
                             {-1.48492424049, -0.857321409974, 5.87877538268},
                             {1.48492424049, -0.857321409974, 5.87877538268}};
    const Outline seat = {{3.63365689213, -2.44055704903, 0.45},
                          {4.04330007655, -2.34786151807, 0.45},
                          {3.9506045456, -1.93821833365, 0.45},
                          {3.54096136118, -2.03091386461, 0.45}};
    const Outline leg = {{3.91287268209, -1.99802056167, 0},
                         {3.9518863187, -1.98919241587, 0},
                         {3.9430581729, -1.95017877926, 0},
                         {3.90404453628, -1.95900692506, 0}};
    std::vector<Outline> faces = {floor, turned(ceiling), seat, turned(lifted(seat, 0.41))};
    prism(leg, lifted(leg, 0.41), faces);  // faces 4 to 7
    prism(lifted(seat, 0.41), seat, faces);
    prism(turned(floor), turned(ceiling), faces);
    return scene_of(faces);
}

TEST(EntryFactors, SumToOneForALegUnderAnOverhangingSeatBetweenSlantingWalls) {
    const ViewFactors table = factors_of(room_with_a_stool(), 1e-4);
    ASSERT_EQ(table.size(), 15U);
    // If rules were chosen by distances to bounding boxes, one sum would be 1.005: walls would seem near everywhere, no
    // rule would be accepted, and the limit on evaluations would be reached. The tolerance is 1e-4 for one entry and
    // 2e-4 for two.
    for (std::size_t leg = 4; leg < 8; ++leg) {
        EXPECT_NEAR(table.row_sums[leg], 1, 1e-4) << leg;
        const double largest = *std::max_element(table.row(leg).begin(), table.row(leg).end());
        for (std::size_t j = 0; j < table.size(); ++j)
            EXPECT_NEAR(table.row(leg)[j], table.areas[j] / table.areas[leg] * table.row(j)[leg], 2e-4 * largest)
                << leg << ' ' << j;
    }
}

TEST(EntryFactors, AreReciprocalForAWallCloselyBehindBoards) {
    // The wall sees between the boards from strips as wide as the gap behind them. Rules whose points all miss the
    // strips agree, but their entries are wrong by 0.6%.
    std::vector<Outline> faces;
    add_box(faces, {0, 0, 0}, {4, 3, 2.5}, true, 1);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 4; ++k) {
            const Point lo = {0.01 + 0.004 * k, 0.13 + 0.95 * i + 0.05 * k, 0.21 + 0.55 * k};
            add_box(faces, lo, lo + Vec3{0.02, 0.31, 0.17}, false, 1);
        }
    const double tolerance = 2e-3;
    const ViewFactors table = factors_of(scene_of(faces), tolerance);
    for (double sum : table.row_sums) EXPECT_NEAR(sum, 1, tolerance);
    EXPECT_LT(table.reciprocity_defect, tolerance);
}

/// Houses of several heights without bottoms that touch only the ground, as in real models of towns.
Scene town_of_boxes() {
    std::vector<Outline> faces;
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y < 3; ++y) {
            const Point lo = {20.0 * x, 20.0 * y, 0};
            std::vector<Outline> house;
            add_box(house, lo, lo + Vec3{10, 10, 12.0 + (5 * x + 7 * y) % 11}, false, 1);
            house.erase(house.begin() + 4);  // its bottom
            faces.insert(faces.end(), house.begin(), house.end());
            const auto tile = [&](double u, double v) {
                faces.push_back({lo + Vec3{u, v, 0}, lo + Vec3{u + 10, v, 0}, lo + Vec3{u + 10, v + 10, 0},
                                 lo + Vec3{u, v + 10, 0}});
            };
            tile(10, 0), tile(0, 10), tile(10, 10);
        }
    return scene_of(faces);
}

/// Expects entries above 1e-6 to agree with those of a finer table within the relative error `share`. Returns their
/// number.
std::size_t entries_within(double share, const ViewFactors& coarse, const ViewFactors& fine) {
    std::size_t entries = 0;
    for (std::size_t i = 0; i < coarse.size(); ++i)
        for (std::size_t j = 0; j < coarse.size(); ++j) {
            const double F = coarse.row(i)[j], exact = fine.row(i)[j];
            if (exact <= 1e-6) continue;
            ++entries;
            EXPECT_NEAR(F / exact, 1, share) << i << ' ' << j << ' ' << exact;
        }
    return entries;
}

TEST(EntryFactors, EveryEntryOfATownAbove1e6IsWithinTheTolerance) {
    const Scene scene = town_of_boxes();
    const double tolerance = 1e-3;
    const ViewFactors coarse = factors_of(scene, tolerance), fine = factors_of(scene, 0.02 * tolerance);
    EXPECT_GT(entries_within(tolerance, coarse, fine), 1000U);
    EXPECT_LE(coarse.entry_defect, tolerance);
    EXPECT_EQ(coarse.unsettled, 0U);
}

TEST(EntryFactors, EntriesOfAFurnishedRoomAreWithinTheTolerance) {
    // A table on four legs, whose bottoms touch the floor, and a box below it.
    std::vector<Outline> faces;
    add_box(faces, {0, 0, 0}, {4, 3, 2.5}, true, 1);
    add_box(faces, {1.2, 0.9, 0.7}, {2.6, 1.9, 0.74}, false, 1);
    for (const double x : {1.25, 2.49})
        for (const double y : {0.95, 1.79}) add_box(faces, {x, y, 0}, {x + 0.06, y + 0.06, 0.7}, false, 1);
    add_box(faces, {1.6, 1.2, 0}, {2.1, 1.5, 0.3}, false, 1);
    const Scene scene = scene_of(faces);
    const double tolerance = 4e-3;
    const ViewFactors coarse = factors_of(scene, tolerance), fine = factors_of(scene, 0.1 * tolerance);
    EXPECT_GT(entries_within(1.1 * tolerance, coarse, fine), 300U);  // the finer table has errors, too
    EXPECT_EQ(coarse.unsettled, 0U);
    EXPECT_EQ(fine.unsettled, 0U);
}

TEST(EntryFactors, CuttingAFaceSplitsItsColumnAndAveragesItsRow) {
    std::vector<Outline> whole, cut;
    add_box(whole, {0, 0, 0}, {4, 3, 2.5}, true, 1);
    add_box(cut, {0, 0, 0}, {4, 3, 2.5}, true, 2);
    for (auto* faces : {&whole, &cut}) add_box(*faces, {1.2, 0.8, 0.3}, {2.5, 1.9, 1.2}, false, 1);
    const ViewFactors w = factors_of(scene_of(whole), 1e-6), c = factors_of(scene_of(cut), 1e-6);
    for (std::size_t wall = 0; wall < 6; ++wall)
        for (std::size_t face = 0; face < 6; ++face) {
            double column = 0, row = 0;
            for (std::size_t piece = 0; piece < 4; ++piece) {
                column += c.row(24 + face)[4 * wall + piece];
                row += c.row(4 * wall + piece)[24 + face] / 4;
            }
            EXPECT_NEAR(w.row(6 + face)[wall], column, 5e-6 * column + 1e-12);  // four entries with a tolerance of 1e-6
            EXPECT_NEAR(w.row(wall)[6 + face], row, 5e-6 * row + 1e-12);
        }
}

TEST(EntryFactors, AreTheSameToTheLastBitOnAnyNumberOfThreads) {
    const Scene scene = room_with_blocks();
    set_threads(1);
    const ViewFactors one = factors_of(scene, 1e-3);
    set_threads(3);
    const ViewFactors three = factors_of(scene, 1e-3);
    set_threads(0);
    EXPECT_EQ(one.factors, three.factors);
}

TEST(EntryFactors, AStopRequestEndsTheWork) {
    Progress progress;
    StopRequest stop;
    stop.interrupt();
    const SparseFactors table = compute_entry_factors(room_with_blocks(), {.tolerance = 1e-3}, nullptr, progress, stop);
    EXPECT_FALSE(table.is_settled);
    EXPECT_EQ(std::count(table.finished.begin(), table.finished.end(), 1), 0);
}

Outline outline_of(const nlohmann::json& json) {
    Outline outline;
    for (const auto& v : json) outline.push_back({v[0], v[1], v[2]});
    return outline;
}

nlohmann::json published() {
    std::ifstream file(test::data_folder() + "/reference/view_factors.json");
    return nlohmann::json::parse(file);
}

TEST(EntryFactors, ReproduceThePublishedPairsWithBlockers) {
    const nlohmann::json table = published();
    for (const auto& c : table["cases"]) {
        if (c["kind"] != "polygon-polygon" || c["occluders"].empty()) continue;
        std::vector<Outline> faces = {outline_of(c["a"]), outline_of(c["b"])};
        for (const auto& o : c["occluders"]) faces.push_back(outline_of(o));
        const Scene scene = scene_of(faces);
        const double exact = c["F_ab"], back = c["F_ba"];
        const ViewFactors fine = factors_of(scene, 1e-9), coarse = factors_of(scene, 1e-4);
        EXPECT_NEAR(fine.row(0)[1] / exact, 1, 1e-7) << c["id"];
        EXPECT_NEAR(fine.row(1)[0] / back, 1, 1e-7) << c["id"];
        EXPECT_NEAR(coarse.row(0)[1] / exact, 1, 1e-4) << c["id"];
    }
}

TEST(EntryFactors, ReproduceThePublishedEnclosures) {
    const nlohmann::json published_table = published();
    for (const auto& e : published_table["enclosures"]) {
        std::vector<Outline> faces;
        for (const auto& face : e["surfaces"]) faces.push_back(outline_of(face["polygon"]));
        const ViewFactors table = factors_of(scene_of(faces), 1e-8);
        for (std::size_t i = 0; i < faces.size(); ++i) {
            EXPECT_NEAR(table.row_sums[i], 1, 1e-6) << e["id"];
            for (std::size_t j = 0; j < faces.size(); ++j)
                EXPECT_NEAR(table.row(i)[j], e["F"][i][j].get<double>(), 1e-6) << e["id"] << " " << i << " " << j;
        }
    }
}

}  // namespace
}  // namespace exitance
