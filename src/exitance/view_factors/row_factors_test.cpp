#include "exitance/view_factors/row_factors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/pair_form_factor.hpp"
#include "exitance/view_factors/row_check.hpp"
#include "support/dense_view_factors.hpp"
#include "support/outline_scene.hpp"

namespace exitance {
namespace {

/// Adds the six faces of a rotated box, with fronts inwards or outwards.
void add_box(std::vector<Outline>& faces, const Point& middle, const Vec3& size, double turn, bool inwards) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double side : {-0.5, 0.5}) {
            Outline face;
            for (const auto& [s, t] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
                Vec3 p;
                p[axis] = side * size[axis];
                p[(axis + 1) % 3] = s * size[(axis + 1) % 3], p[(axis + 2) % 3] = t * size[(axis + 2) % 3];
                const double c = std::cos(turn), d = std::sin(turn);
                face.push_back(middle + Vec3{c * p.x - d * p.y, d * p.x + c * p.y, p.z});
            }
            if ((side > 0) == inwards) std::reverse(face.begin(), face.end());
            faces.push_back(face);
        }
}

/// A closed room with three boxes, one of which stands on the floor.
Scene furnished_room() {
    std::vector<Outline> faces;
    add_box(faces, {2, 1.5, 1.25}, {4, 3, 2.5}, 0, true);
    add_box(faces, {1.1, 1, 0.6}, {0.8, 0.7, 0.9}, 0.3, false);
    add_box(faces, {2.7, 1.7, 0.9}, {0.9, 1.1, 1.3}, -0.5, false);
    add_box(faces, {3.2, 0.5, 0.4}, {0.3, 0.3, 0.8}, 0.2, false);
    return scene_of(faces);
}

/// Keeps rows in memory and requests a stop after `most` of them.
class StoppingStore final : public RawRowStore {
  public:
    StoppingStore(std::vector<RawRow>& rows, StopRequest& stop, std::size_t most)
        : rows_(rows), stop_(stop), max_(most) {}
    std::vector<RawRow> resumed() override { return rows_; }
    void keep(const RawRow& row) override {
        rows_.push_back(row);
        if (++kept_ == max_) stop_.interrupt();
    }

  private:
    std::vector<RawRow>& rows_;
    StopRequest& stop_;
    std::size_t max_, kept_ = 0;
};

SparseFactors factors_of(const Scene& scene, const RowFactorOptions& options) {
    Progress progress;
    return compute_row_factors(scene, options, nullptr, progress, StopRequest());
}

double entry(const SparseFactors& table, std::size_t i, std::size_t j) {
    const auto columns = table.row_columns(i);
    const auto at = std::lower_bound(columns.begin(), columns.end(), j);
    return at != columns.end() && *at == j ? table.row_values(i)[static_cast<std::size_t>(at - columns.begin())] : 0;
}

TEST(RowFactors, RowsReachTheRequestedErrorComparedWithQuadrature) {
    const Scene scene = furnished_room();
    const double R = 3e-3;
    const SparseFactors table = factors_of(scene, {.error = R});
    const ViewFactors exact = dense_view_factors(scene, 1e-4);
    double squares = 0;
    for (std::size_t i = 0; i < table.size(); ++i) {
        EXPECT_LE(table.row_errors[i], R) << i;
        double row = 0;
        for (std::size_t j = 0; j < table.size(); ++j) row += std::pow(entry(table, i, j) - exact.row(i)[j], 2);
        squares += row / static_cast<double>(table.size());
        EXPECT_LE(std::sqrt(row), 2.5 * R) << i;  // R is a standard deviation; 2.5 of them are rarely exceeded
    }
    EXPECT_LE(std::sqrt(squares), R);
}

TEST(RowFactors, RowsSeldomExceedTheRequestedError) {
    const Scene scene = furnished_room();
    const double R = 3e-3;
    const ViewFactors exact = dense_view_factors(scene, 1e-4);
    std::size_t rows = 0, above = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const SparseFactors table = factors_of(scene, {.error = R, .seed = seed});
        for (std::size_t i = 0; i < table.size(); ++i) {
            double row = 0;
            for (std::size_t j = 0; j < table.size(); ++j) row += std::pow(entry(table, i, j) - exact.row(i)[j], 2);
            ++rows, above += std::sqrt(row) > R;
        }
    }
    EXPECT_LE(above, rows / 33);  // one in 100 is expected; a quarter exceeded R when R was a standard deviation
}

TEST(RowFactors, AreReciprocalAndClosed) {
    const Scene scene = furnished_room();
    const SparseFactors table = factors_of(scene, {.error = 3e-3});
    ASSERT_TRUE(table.combined);
    EXPECT_GT(table.reciprocity_defect, 0);  // rows were computed independently
    for (std::size_t i = 0; i < table.size(); ++i)
        for (std::size_t j = 0; j < table.size(); ++j)
            EXPECT_NEAR(table.areas[i] * entry(table, i, j), table.areas[j] * entry(table, j, i), 1e-14);
    // Only fronts are visible from the walls other than the floor, which the third box covers in part. One ray in
    // 20,000 may hit the edge between two faces and count as missed.
    EXPECT_EQ(table.unclosed, 0U);
    for (const std::size_t wall : {0, 1, 2, 3, 5}) EXPECT_NEAR(table.row_sums[wall], 1, 1e-4) << wall;
}

TEST(RowFactors, PassTheCheckByRaysUnlikeATableOfZeros) {
    const Scene scene = furnished_room();
    const double R = 3e-3;
    SparseFactors table = factors_of(scene, {.error = R});
    const RowCheckOptions options{.rows = 8, .rays = 30'000, .error = R};
    EXPECT_EQ(check_rows_by_rays(scene, table, options, StopRequest()).wrong, 0U);
    SparseFactors moved = table;  // row sums are correct, entries are not
    for (std::size_t i = 0; i < moved.size(); ++i)
        std::reverse(moved.values.begin() + std::ptrdiff_t(moved.starts[i]),
                     moved.values.begin() + std::ptrdiff_t(moved.starts[i + 1]));
    EXPECT_GT(check_rows_by_rays(scene, moved, options, StopRequest()).wrong, 4U);
    std::fill(table.values.begin(), table.values.end(), 0);
    EXPECT_EQ(check_rows_by_rays(scene, table, options, StopRequest()).wrong, 8U);
}

TEST(RowFactors, AreTheSameOnAnyNumberOfThreadsAndAfterStops) {
    const Scene scene = furnished_room();
    const RowFactorOptions options{.error = 1e-2};
    set_threads(1);
    const SparseFactors one = factors_of(scene, options);
    set_threads(3);
    EXPECT_EQ(factors_of(scene, options).values, one.values);
    set_threads(0);
    std::vector<RawRow> rows;
    Progress progress;
    for (const std::size_t most : {5, 9}) {
        StopRequest stop;
        StoppingStore store(rows, stop, most);
        const SparseFactors part = compute_row_factors(scene, options, &store, progress, stop);
        if (part.combined) continue;  // a stop in the last step has no effect
        EXPECT_EQ(std::count(part.finished.begin(), part.finished.end(), 1), std::ptrdiff_t(rows.size()));
    }
    StopRequest never;
    StoppingStore store(rows, never, SIZE_MAX);
    EXPECT_EQ(compute_row_factors(scene, options, &store, progress, never).values, one.values);
}

TEST(RowFactors, SmallEntriesAreDroppedAndCounted) {
    const Scene scene = furnished_room();
    const SparseFactors all = factors_of(scene, {.error = 1e-2});
    const SparseFactors some = factors_of(scene, {.error = 1e-2, .smallest = 0.01});
    EXPECT_LT(some.entries(), all.entries());
    EXPECT_GE(*std::min_element(some.values.begin(), some.values.end()), 0.01);
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_NEAR(some.row_sums[i] + some.dropped[i], all.row_sums[i], 1e-14) << i;
        EXPECT_NEAR(some.row_errors[i], all.row_errors[i] + some.dropped[i], 1e-14) << i;
    }
}

TEST(RowFactors, CountTheSkyAndBacksOfFaces) {
    // Two opposite unit squares at distance 1, the lower one with an opaque lid over half of it that shows it its back.
    const Outline low = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                  high = {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}};
    const double R = 1e-3, F = 0.199824895698387;  // Howell's C-11
    const SparseFactors open = factors_of(scene_of({low, high}), {.error = R});
    EXPECT_NEAR(entry(open, 0, 1), F, R);
    EXPECT_NEAR(open.sky[0], 1 - F, 3 * R);
    EXPECT_EQ(open.back[0], 0);
    const Outline away(high.rbegin(), high.rend());  // the back of this face is below
    const SparseFactors turned = factors_of(scene_of({low, away}), {.error = R});
    EXPECT_EQ(entry(turned, 0, 1), 0);
    EXPECT_NEAR(turned.back[0], F, 3 * R);
    EXPECT_NEAR(turned.sky[0], 1 - F, 3 * R);
    EXPECT_NEAR(turned.sky[1], 1, 1e-12);
    for (const SparseFactors* table : {&open, &turned}) {
        EXPECT_EQ(table->unclosed, 0U);
        for (std::size_t i = 0; i < 2; ++i)
            EXPECT_NEAR(table->row_sums[i] + table->sky[i] + table->back[i], 1, 3 * R) << i;
    }
}

/// The sky between two plates of 10 x 10 m, 1 mm apart, is seen by one ray in 5,000: often by none.
TEST(RowFactors, ShareOfASkyThatNoRayReachesFollowsFromTheSum) {
    const Outline low = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}},
                  high = {{0, 10, 0.001}, {10, 10, 0.001}, {10, 0, 0.001}, {0, 0, 0.001}};
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const SparseFactors table = factors_of(scene_of({low, high}), {.error = 1e-3, .seed = seed});
        EXPECT_EQ(table.unclosed, 0U) << seed;
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_NEAR(table.sky[i], 2e-4, 2e-6) << seed;  // 2 h / L, less than 1% smaller
            EXPECT_NEAR(table.row_sums[i] + table.sky[i], 1, 1e-7) << seed;
        }
    }
}

TEST(RowFactors, KeepInvariantsOnRandomScenes) {
    const double R = 3e-3;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        RandomStream random(seed, Stream::reference, 1);
        const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
        std::vector<Outline> faces;
        for (int k = 0; k < 4; ++k) {  // boxes in different quadrants, so that they do not intersect
            // In separate statements, since compilers evaluate arguments in different orders.
            const double turn = between(0, 3);
            const Vec3 size{between(0.3, 1.1), between(0.3, 1.1), between(0.3, 1.5)};
            const Point centre{2.0 * (k % 2) + between(0.9, 1.1), 2.0 * (k / 2) + between(0.9, 1.1), between(0, 2)};
            add_box(faces, centre, size, turn, false);
        }
        const SparseFactors without = factors_of(scene_of(faces), {.error = R});
        std::vector<Outline> more = faces;
        const double at = between(0, 4);  // position of a screen through the scene
        more.push_back({{at, -1, -1}, {at, 5, -1}, {at + 0.3, 5, 3}, {at + 0.3, -1, 3}});
        const SparseFactors with = factors_of(scene_of(more), {.error = R});
        for (std::size_t i = 0; i < without.size(); ++i) {
            EXPECT_NEAR(without.row_sums[i] + without.sky[i] + without.back[i], 1, 3 * R) << seed << ' ' << i;
            for (std::size_t j = 0; j < without.size(); ++j) {
                const double F = entry(without, i, j);
                EXPECT_TRUE(F >= 0 && F <= 1) << seed << ' ' << i << ' ' << j;
                // tolerance: three standard errors of each entry
                EXPECT_LE(entry(with, i, j), F + 6 * R) << seed << ' ' << i << ' ' << j;
                EXPECT_NEAR(without.areas[i] * F, without.areas[j] * entry(without, j, i), 1e-12);
            }
        }
    }
}

TEST(RowFactors, CuttingAFaceAddsUp) {
    std::vector<Outline> whole, cut;
    add_box(whole, {0, 0, 0}, {3, 2, 2}, 0.4, true), add_box(whole, {0.3, 0.2, 0.1}, {0.8, 0.6, 0.7}, 0.9, false);
    cut = whole;
    const Outline wall = cut[1];
    const Point below = wall[0] + 0.3 * (wall[1] - wall[0]), above = wall[3] + 0.3 * (wall[2] - wall[3]);
    cut[1] = {wall[0], below, above, wall[3]};
    cut.push_back({below, wall[1], wall[2], above});
    const double R = 2e-3;
    const SparseFactors a = factors_of(scene_of(whole), {.error = R}), b = factors_of(scene_of(cut), {.error = R});
    const std::size_t last = b.size() - 1;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (i == 1) continue;
        EXPECT_NEAR(entry(a, i, 1), entry(b, i, 1) + entry(b, i, last), 6 * R) << i;
        EXPECT_NEAR(entry(a, 1, i), 0.3 * entry(b, 1, i) + 0.7 * entry(b, last, i), 6 * R) << i;
    }
}

TEST(RowFactors, MovingAndScalingTheSceneChangesOnlyNoise) {
    std::vector<Outline> near, far;
    add_box(near, {0, 0, 0}, {2, 2, 2}, 0.4, true), add_box(near, {0.1, 0.2, 0}, {0.7, 0.5, 0.6}, 0.9, false);
    for (const Outline& outline : near) {
        Outline& moved = far.emplace_back();
        for (const Point& p : outline) moved.push_back(1000.0 * p + Vec3{7000, -3000, 500});
    }
    const double R = 3e-3;
    const SparseFactors a = factors_of(scene_of(near), {.error = R}), b = factors_of(scene_of(far), {.error = R});
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < a.size(); ++j) EXPECT_NEAR(entry(a, i, j), entry(b, i, j), 3 * R) << i << ' ' << j;
}

/// Two beams that lie on each other, with the rounding of nine digits 100 m from the origin: the faces of the contact
/// are some 1e-8 m apart, not parallel, and must not see each other.
TEST(RowFactors, BeamsThatTouchDoNotSeeEachOtherHoweverTheyAreRotated) {
    std::vector<Outline> boxes;
    add_box(boxes, {0, 1.5, 2.475}, {4.8, 0.1, 0.15}, 0, false);
    add_box(boxes, {0, 0, 2.6}, {0.04, 4, 0.1}, 0, false);
    const Frame frame(normalized(Vec3{0.3, -0.5, 0.7}));
    RandomStream random(1, Stream::rows);
    for (Outline& outline : boxes)
        for (Point& p : outline) {
            p = Point{61, -53, 59} + frame.to_world(p.x, p.y, p.z);
            for (std::size_t k = 0; k < 3; ++k) p[k] += 1e-7 * (random.uniform() - 0.5);
        }
    const SparseFactors table = factors_of(scene_of(boxes), {.error = 1e-3});
    EXPECT_EQ(table.unclosed, 0U);
    for (std::size_t i = 0; i < table.size(); ++i) EXPECT_LE(table.row_errors[i], 1e-3) << i;
    const std::size_t top = 5, bottom = 10;  // of the lower and of the upper beam
    EXPECT_EQ(entry(table, top, bottom), 0);
    EXPECT_EQ(entry(table, bottom, top), 0);
    EXPECT_NEAR(table.back[top], 0.04 / 4.8, 2e-3);
    EXPECT_NEAR(table.back[bottom], 0.1 / 4, 2e-3);
}

/// A square touches a larger face along one of its edges. Rays from near that edge must not start behind the other
/// face.
TEST(RowFactors, FacesThatTouchAlongAnEdgeHaveExactFactors) {
    struct Place {
        Point apex;
        double scale;
    };
    for (const double degrees : {1.0, 7.6, 30.0, 60.0, 120.0})
        for (const Vec3& up : {Vec3{0, 0, 1}, Vec3{0.3, -0.5, 0.7}})
            for (const Place& place : {Place{{0, 0, 0}, 1}, Place{{1000, 0, 30}, 1}, Place{{0.1, 0.2, 0.3}, 1e3},
                                       Place{{0.1, 0.2, 0.3}, 1e-3}}) {
                const Frame frame(normalized(up));
                const auto at = [&](double x, double y, double z) {
                    return place.apex + place.scale * frame.to_world(x, y, z);
                };
                const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
                const Outline square = {at(0, 0, 0), at(0.1, 0, 0), at(0.1, 0.1, 0), at(0, 0.1, 0)},
                              large = {at(-5, 6 * c, 6 * s), at(5, 6 * c, 6 * s), at(5, 0, 0), at(-5, 0, 0)};
                const Scene scene = scene_of({square, large});
                const double R = 3e-4, F = pair_form_factor(square, large);
                const SparseFactors table = factors_of(scene, {.error = R});
                EXPECT_EQ(table.unclosed, 0U);
                EXPECT_NEAR(entry(table, 0, 1), F, R) << degrees;
                EXPECT_NEAR(entry(table, 1, 0), F * table.areas[0] / table.areas[1], R) << degrees;
                for (std::size_t i = 0; i < 2; ++i) {
                    EXPECT_LE(table.row_errors[i], R);
                    EXPECT_LE(table.back[i], 2e-4) << degrees;  // NarrowGaps leaves out gaps below that share
                    EXPECT_NEAR(table.row_sums[i] + table.sky[i], 1, R) << degrees;
                }
                const RowCheck check = check_rows_by_rays(scene, table, {.rows = 2, .error = R}, StopRequest());
                EXPECT_EQ(check.wrong, 0U) << degrees;
            }
}

}  // namespace
}  // namespace exitance
