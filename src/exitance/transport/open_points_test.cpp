#include "exitance/transport/open_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A floor of 4 x 4 m and faces above it, turned about an axis that is not one of the coordinates', moved and scaled.
class Placed {
  public:
    Placed(double turn, double scale, const Vec3& move)
        : frame_(normalized(Vec3{std::sin(turn), 0.3, std::cos(turn)})), scale_(scale), move_(move) {}

    Point at(double x, double y, double z) const { return Point{} + move_ + scale_ * frame_.to_world(x, y, z); }
    Normal up() const { return frame_.to_world(0, 0, 1); }
    std::vector<Point> rectangle(double lo, double hi, double z, bool faces_up) const {
        std::vector<Point> out{at(lo, lo, z), at(hi, lo, z), at(hi, hi, z), at(lo, hi, z)};
        if (!faces_up) std::reverse(out.begin(), out.end());
        return out;
    }
    /// Walls around the square, with their fronts outside.
    std::vector<test::Face> walls(double lo, double hi, double z) const {
        std::vector<test::Face> out;
        const double x[] = {lo, hi, hi, lo}, y[] = {lo, lo, hi, hi};
        for (int i = 0; i < 4; ++i) {
            const int k = (i + 1) % 4;
            out.push_back({{at(x[i], y[i], 0), at(x[k], y[k], 0), at(x[k], y[k], z), at(x[i], y[i], z)}});
        }
        return out;
    }

  private:
    Frame frame_;
    double scale_;
    Vec3 move_;
};

const Placed places[] = {{0, 1, {}}, {0.7, 1, {1000, -200, 30}}, {2.1, 1e-3, {}}, {0.4, 1e3, {}}};

bool is_open(const std::vector<test::Face>& faces, const Placed& in, double x, double y) {
    const Scene scene = test::make(faces);
    const Stage stage(scene);
    RegionId floor;
    for (RegionId r : scene.regions().ids())
        if (floor.is_none() || scene.regions()[r].area > scene.regions()[floor].area) floor = r;
    return is_in_open(stage, in.at(x, y, 0), in.up(), floor);
}

TEST(OpenPoints, AreThoseBelowTheBackOfASheet) {
    // The back of the sheet is all that steep rays from below see.
    for (const Placed& in : places)
        for (const double height : {0.02, 0.1, 0.3}) {
            const std::vector<test::Face> faces{{in.rectangle(0, 4, 0, true)}, {in.rectangle(1.5, 2.5, height, true)}};
            for (const double x : {1.6, 2.0, 2.4}) EXPECT_TRUE(is_open(faces, in, x, 2)) << height << " " << x;
        }
}

TEST(OpenPoints, AreNotThoseInsideABody) {
    for (const Placed& in : places)
        for (const double height : {0.1, 1.0}) {
            // The body has no bottom, as the leg of a table.
            std::vector<test::Face> faces{{in.rectangle(0, 4, 0, true)}, {in.rectangle(1.5, 2.5, height, true)}};
            for (const test::Face& wall : in.walls(1.5, 2.5, height)) faces.push_back(wall);
            for (const double x : {1.52, 2.0, 2.48}) EXPECT_FALSE(is_open(faces, in, x, 2)) << height << " " << x;
            EXPECT_TRUE(is_open(faces, in, 1.4, 2)) << height;
        }
}

}  // namespace
}  // namespace exitance
