#include "exitance/direct/direct_light.hpp"

#include <gtest/gtest.h>

#include "exitance/transport/stage.hpp"
#include "support/test_scenes.hpp"

namespace exitance {

TEST(DirectLight, ASheetDoesNotShadeItself) {
    // A slanted two-sided sheet under a lamp; its corners are rounded to twelve digits and thus not exactly in a plane.
    const std::vector<Point> sheet = {{0.331234567891, -1.2, 0.123456789012},
                                      {5.123456789013, -0.7, 1.234567890123},
                                      {4.9, 3.1, 1.987654321098},
                                      {0.1, 2.6, 0.876543210987}};
    std::vector<Point> front = sheet, back(sheet.rbegin(), sheet.rend());
    front[3] += Vec3{0, 0,
                     dot(area_vector(std::vector<Point>{sheet[0], sheet[1], sheet[2]}), sheet[0] - sheet[3]) /
                         area_vector(std::vector<Point>{sheet[0], sheet[1], sheet[2]}).z};
    front[3].z = std::round(front[3].z * 1e11) * 1e-11;
    back[0] = front[3];
    const Scene scene = test::make({{front}, {back}, {{{2, 0, 4}, {2, 1, 4}, {3, 1, 4}, {3, 0, 4}}, 10}});
    const Stage stage(scene);
    const RegionId own = scene.surfaces()[SurfaceId(0)].region;
    const Normal n = scene.surfaces()[SurfaceId(0)].normal;
    DirectLight::Workspace workspace;
    for (int i = 1; i < 20; ++i) {
        const Point x = front[0] + (0.04 * i) * (front[1] - front[0]) + 0.3 * (front[3] - front[0]);
        for (const double off : {-1e-9, 0.0, 1e-9})
            EXPECT_GT(stage.direct.irradiance(x + off * n, n, own, workspace)[0], 0) << i << ' ' << off;
    }
}

}  // namespace exitance
